import type { PlacingTexts } from "./index.js";

export const placing: PlacingTexts = {
  points: {
    title: "Puntos de soporte",
    hint: "Haga clic en el modelo para añadir un punto; arrástrelo para moverlo.",
    unreached: "No alcanzados",
    selected: (number, all, height) => `Punto ${number} de ${all}, a ${height}`,
    none: "Ningún punto seleccionado",
    lockHint: "Un punto bloqueado se queda cuando los puntos se colocan automáticamente.",
  },
  drains: {
    title: "Agujeros de drenaje",
    hint: "Haga clic en el modelo para añadir un agujero; arrástrelo para moverlo.",
    unreached: "Fuera del hueco",
    selected: (number, all, height) => `Agujero ${number} de ${all}, a ${height}`,
    none: "Ningún agujero seleccionado",
    lockHint: "Un agujero bloqueado se queda cuando los agujeros se colocan automáticamente.",
  },
  automatic: "Automáticos",
  byHand: "A mano",
  diameter: "Diámetro (mm)",
  newDiameter: "Diámetro de los agujeros nuevos (mm)",
  lock: "Bloqueado",
  remove: "Eliminar",
  protect: "Alejar puntos y agujeros de lo pintado como importante",
  protectHint: "Vale para puntos y agujeros. Pinte antes con «Qué importa».",
  plugs: "Descargar tapones (STL)",
  plugsHint: "Clavijas que cierran los agujeros: imprímalas y péguelas con resina.",
  automatically: "Colocar automáticamente",
  clear: "Quitar todos",
};
