import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { BODIES, CAVITIES, EDGES, FACETS, FAULTS, HOLES, LAYERS, OBJECTS, PARTS, PART_KINDS, POINTS, UNITS } from "./nouns.js";

export const warnings = ({ count, counted, exact, mm, tick, height, volume, error, either }: Format): WarningSentences => ({
  "degenerate-facets": ({ facets }) => `${counted(facets, FACETS)} ohne Fläche weggelassen.`,
  "inside-out": () => "Das Netz war von innen nach außen gekehrt und wurde umgedreht.",
  "turned-facets": ({ facets }) => `${counted(facets, FACETS)} falsch herum, wurden umgedreht.`,
  unorientable: ({ edges }) => `An ${counted(edges, EDGES)} können nicht alle Dreiecke in dieselbe Richtung zeigen: was dort innen ist, ist geraten. Sehen Sie sich die Masken an.`,
  "open-mesh": ({ open_edges, holes }) =>
    `Das Netz ist nicht geschlossen: ${counted(open_edges, EDGES)} ohne Gegenstück, ${counted(holes, HOLES)} geschlossen. Sehen Sie sich die Masken an.`,
  "skipped-objects": ({ objects }) => `${counted(objects, OBJECTS)} der Datei weggelassen: Stützen, Flächen oder nicht zum Drucken.`,
  "subtracted-part": ({ name }) => `Das Teil „${name}“ wird abgezogen.`,
  "skipped-part": ({ name, kind }) => `${PART_KINDS[kind]} „${name}“ wird weggelassen.`,
  "other-plates": ({ plate_number, plates }) => `Platte ${count(plate_number)} von ${count(plates)} wird gelesen.`,
  "odd-size": ({ size_mm, readings }) =>
    `Die Datei nennt keine Einheit, und in Millimetern ist das Modell ${mm(size_mm)} lang; ` +
    readings.map(({ unit, size_mm }) => `in ${UNITS[unit]} wären es ${mm(size_mm)}; `).join("") +
    "geben Sie die Einheit an, wenn es eine andere ist.",
  "unit-stated": ({ stated, given }) => `Die Datei ist, wie sie sagt, in ${UNITS[stated]} und nicht in ${UNITS[given]}.`,
  "nothing-hollowed": ({ wall_mm, cavity_mm }) =>
    `Das Modell bleibt voll: Es ist nirgends dick genug für Wände von ${mm(wall_mm)} um einen Hohlraum von ${mm(cavity_mm)}.`,
  "nothing-to-drain": () => "Das Modell hat keinen geschlossenen Hohlraum, darum gibt es kein Ablaufloch. Höhlen Sie es aus.",
  "drain-astray": ({ drain_number }) =>
    `Ablaufloch ${count(drain_number)} trifft keinen Hohlraum und fehlt. Setzen Sie es dorthin, wo das Modell hohl ist, oder richten Sie es nach innen.`,
  undrained: ({ basins }) =>
    `${counted(basins, PARTS)} des Hohlraums: Dort bleibt Harz, denn kein Loch führt waagrecht oder abwärts hinaus. Setzen Sie dort Löcher, oder drehen Sie das Modell.`,
  "closed-cavities": ({ cavities, volume_mm3, at_mm }) =>
    `${counted(cavities, CAVITIES)} des Modells geschlossen, mit ${volume(volume_mm3)} Harz darin, der größte bei ${at_mm.map(tick).join("; ")}. Bohren Sie Löcher dorthin, oder füllen Sie sie.`,
  "support-astray": ({ point_number }) => `Stütze ${count(point_number)} liegt nicht auf dem Modell und wurde weggelassen. Setzen Sie sie auf die Oberfläche.`,
  unsupported: ({ points }) => `${counted(points, POINTS)} ohne Stütze, weil keine dorthin führt. Drehen Sie das Modell, oder wählen Sie leichtere Stützen.`,
  "unclosed-rays": ({ unclosed, rays }) =>
    `${count(unclosed)} von ${count(rays)} Strahlen gehen durch Löcher des Netzes, die geschlossen sind. Sehen Sie sich die Masken an.`,
  "missed-bodies": ({ bodies, at_mm }) =>
    `${counted(bodies, BODIES)} in allen Masken, der größte bei ${at_mm.map(tick).join("; ")}: schmaler als ein Pixel und von keinem Strahl getroffen. Machen Sie ihn dicker, oder wählen Sie kleinere Pixel.`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `Der Fehler erreicht ${error(metric, max_error)}, mehr als die Toleranz von ${error(metric, tolerance)}.`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `Am Netz selbst erreicht der Fehler ${error(metric, max_error)}, mehr als die Toleranz von ${error(metric, tolerance)}: Strahlen verfehlen einen Teil der Oberfläche.`,
  "sampled-sections": () => "Die Oberfläche schneidet sich selbst; Querschnitte werden entlang von Strahlen gezählt.",
  "top-moved": ({ top_mm, height_mm }) =>
    `Der Druck endet bei ${mm(top_mm)}, weil die Schichten nicht genau ${mm(height_mm)} ergeben.`,
  "black-layers": ({ layers, from_mm }) =>
    `${counted(layers, LAYERS)} des Plans ohne belichteten Pixel, ab ${height(from_mm)}: Teile schweben in der Luft oder sind dünner als ein Pixel. Sehen Sie sich dort die Masken an.`,
  "erased-parts": ({ layers, from_mm, area_mm2 }) =>
    `Die Kompensation löscht Teile in ${counted(layers, LAYERS)}, ab ${height(from_mm)}, höchstens ${tick(area_mm2)}\u00a0mm² in einer: Sie sind nicht dicker als das, was sie wegnimmt. Machen Sie sie dicker, oder setzen Sie eine kleinste Breite, die sie stehen lässt.`,
  "one-thickness": ({ taker, best }) =>
    `${taker} nimmt eine Dicke für alle Schichten, und dieser Plan hat mehrere; ` +
    (best === null
      ? "wählen Sie gleichmäßige Schichten."
      : `${count(best.layers)} gleichmäßige Schichten von ${mm(best.layer_mm)} halten die Toleranz ein.`),
  "extrapolated-exposures": ({ layers, thinnest_mm, thickest_mm }) =>
    `Die Belichtung von ${counted(layers, LAYERS)} ist hochgerechnet, da Belichtungen nur von ${exact(thinnest_mm)} bis ${mm(thickest_mm)} gemessen sind; messen Sie auch diese, oder halten Sie kleinste und größte Schichtdicke in diesem Bereich.`,
  "untried-thicknesses": ({ model }) =>
    `Niemand hat berichtet, ob der ${model} verschieden dicke Schichten druckt; drucken Sie die Testtürme, oder wählen Sie gleichmäßige Schichten.`,
  "untried-slicer": ({ slicers }) =>
    `Niemand hat berichtet, ob ${either(slicers)} die Schichten einer solchen Datei wie geplant druckt; vergleichen Sie vor dem Druck Zahl und Höhen der Schichten in der Vorschau dort.`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `Die CPU hat die Arbeit der GPU übernommen: Das Netz braucht einen Puffer von ${count(needed_bytes)} Byte, und die GPU bietet ${count(limit_bytes)}.`,
  "gpu-failed": ({ fault, system }) =>
    `Die CPU hat die Arbeit der GPU übernommen, die versagt hat: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
});
