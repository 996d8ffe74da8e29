import type { UniformLayers } from "../../api/wire.js";
import type { Format } from "../format.js";
import { adviceOn, ended, FILE_KINDS, flatKind, STL_KEYWORDS, type ErrorSentences, type QuantityNouns, type StlNouns, type WorkWords } from "../sentences.js";
import { FACETS, FAULTS } from "./nouns.js";
import { readers } from "./readers.js";

const QUANTITIES: QuantityNouns = {
  pitch: "El paso de los píxeles",
  bin: "La altura de los intervalos",
  step: "El paso del motor",
  layer: "El espesor de capa",
  "first-layer": "La primera capa",
  "layer-min": "El espesor de capa mínimo",
  "layer-max": "El espesor de capa máximo",
  tolerance: "La tolerancia",
  "resin-layer": "El espesor de capa de la resina",
  penetration: "La profundidad de penetración",
  exposure: "La exposición",
  "bottom-exposure": "La exposición de las capas de base",
  wait: "La espera entre capas",
  lift: "La altura de elevación",
  "lift-speed": "La velocidad de elevación",
  "return-speed": "La velocidad de retorno",
  density: "La densidad de la resina",
};

const WORK: WorkWords = {
  hits: ["El muestreo del modelo", " o elija píxeles mayores"],
  layers: ["La planificación", " o elija intervalos más grandes o menos espesores"],
  saliency: ["Hallar lo que destaca", ", prescinda de ello o use un modelo con menos facetas"],
  all: ["Esto", ""],
};

const EXPECTED: StlNouns = {
  ...STL_KEYWORDS,
  "facet-or-endsolid": "`facet` o `endsolid`",
  "normal-number": "un número de la normal",
  coordinate: "una coordenada",
};

const inPlace = (best: UniformLayers | null | undefined, { count, mm }: Pick<Format, "count" | "mm">): string =>
  best ? `${count(best.layers)} capas uniformes de ${mm(best.layer_mm)}, que cumplen la tolerancia` : "capas uniformes";

export const errors = ({ count, counted, exact, mm, measure, error, either }: Format): ErrorSentences => ({
  ...readers({ count }),
  "file-empty": () => "El archivo está vacío; exporte el modelo de nuevo.",
  "unknown-file-kind": () => "No es un modelo que Cusp lea; expórtelo como STL, 3MF u OBJ.",
  "no-plate": ({ plate_number, plates }) => `No hay placa ${count(plate_number)}: el archivo tiene ${count(plates)}.`,
  "other-file-kind": ({ kind }) =>
    flatKind(kind, { picture: "una imagen", document: "un documento", drawing: "un dibujo" }, (noun) => `Es ${noun} (${FILE_KINDS[kind]}); Cusp abre STL, 3MF, OBJ y archivos de impresión.`) ??
    `Es un archivo ${FILE_KINDS[kind]}, que Cusp no lee; ${adviceOn(kind, {
      model: "exporte el modelo como STL, 3MF u OBJ",
      packed: "descomprímalo y abra el modelo que contiene",
      page: "descargue el modelo mismo; quizá la dirección pida iniciar sesión o lleve a una página sobre él",
    })}.`,
  "stl-truncated": (detail) =>
    "line" in detail
      ? `El STL está cortado: termina en la línea ${count(detail.line)}, donde debería seguir ${EXPECTED[detail.expected]}.`
      : `El STL está cortado: su cabecera anuncia ${counted(detail.declared_facets, FACETS)}, que ocupan ${count(detail.expected_bytes)} bytes, ` +
        `pero el archivo termina en el byte ${count(detail.found_bytes)}; cópielo o expórtelo de nuevo.`,
  "stl-wrong-facet-count": ({ declared_facets, found_facets }) =>
    `El número de facetas no es correcto: la cabecera anuncia ${counted(declared_facets, FACETS)} en el byte 80, pero siguen ${count(found_facets)}; exporte el modelo de nuevo.`,
  "stl-not-finite": (detail) =>
    "line" in detail
      ? `Línea ${count(detail.line)}: \`${detail.text}\` no es un número finito; exporte el modelo de nuevo.`
      : `La coordenada en el byte ${count(detail.byte)} (faceta ${count(detail.facet)}) no es un número finito; exporte el modelo de nuevo.`,
  "stl-syntax": ({ line, expected, found }) =>
    `Línea ${count(line)}: se esperaba ${EXPECTED[expected]}, pero hay \`${found}\`; exporte el modelo de nuevo.`,
  "stl-no-facets": () => "El STL no contiene facetas; exporte el modelo de nuevo.",
  "mesh-no-area": ({ facets }) => `Ninguna faceta tiene área (de ${count(facets)}); exporte el modelo de nuevo.`,
  "mesh-zero-height": () => "El modelo no tiene altura; ¿es plano, o está tendido en el plano z = constante?",
  "mesh-overflow": () => "El modelo es demasiado grande: con esta altura mide más de un kilómetro; elija otra unidad u otra altura.",
  "bad-height": ({ height_mm }) => `La altura debe ser mayor que 0, no ${mm(height_mm)}.`,
  "bad-rotation": () => "El giro debe ser un cuaternión x, y, z, w cuya longitud no sea cero.",
  "bad-length": ({ quantity, value, unit, least, most }, metric) =>
    `${QUANTITIES[quantity]} debe estar entre ${exact(least)} y ${measure(most, unit, metric)}, y no ser ${measure(value, unit, metric)}.`,
  "bad-time": ({ quantity, value_s, most_s }) => `${QUANTITIES[quantity]} debe estar entre 0 y ${measure(most_s, "s")}, y no ser ${measure(value_s, "s")}.`,
  "bad-exposures": ({ previous_mm, next_mm }) =>
    `Las exposiciones medidas deben ir en orden de espesor, cada una más gruesa que la anterior, pero ${mm(next_mm)} sigue a ${mm(previous_mm)}.`,
  "bad-growth": ({ least_mm, most_mm, value_mm }) =>
    `El crecimiento de una impresión debe estar entre ${exact(least_mm)} y ${mm(most_mm)}, y no ser ${mm(value_mm)}.`,
  "bad-options": ({ system }) => `No se pueden leer las opciones: ${ended(system)}`,
  "unknown-printer": ({ printer, similar, known }) =>
    `Entre las ${count(known)} impresoras conocidas no hay ninguna ${printer}${similar.length === 0 ? "" : `; se parecen ${similar.join(", ")}`}.`,
  "bad-printer": ({ printer, field }) => `La impresora ${printer} no puede tener ese valor de ${field}; corrija su descripción.`,
  "printer-not-json": ({ system }) => `Este archivo no describe una impresora en JSON: ${ended(system)}`,
  "printer-too-long": ({ bytes, most_bytes }) => `La descripción de una impresora tiene como máximo ${count(most_bytes)} bytes y este archivo tiene ${count(bytes)}; elija otro archivo.`,
  "pixels-without-pitch": () => "Los píxeles y su paso en x e y van juntos; indique ambos, o un solo paso para x e y.",
  "bad-antialias": ({ antialias, known }) => `El suavizado tiene los niveles ${known.join(", ")}, no ${exact(antialias)}.`,
  "bad-size": ({ option, value_mm, least_mm, most_mm }) => `${option} debe estar entre ${mm(least_mm)} y ${mm(most_mm)}, no ser ${mm(value_mm)}.`,
  "bad-weight-min": ({ weight_min }) => `El peso mínimo debe estar entre 0 y 1, no ser ${exact(weight_min)}.`,
  "bad-directions": ({ directions, most }) => `Una búsqueda mira de 1 a ${count(most)} direcciones, no ${count(directions)}.`,
  "bad-limit": ({ limit, value, least, most }) => `${limit} debe estar entre ${exact(least)} y ${exact(most)}, no ser ${exact(value)}.`,
  "bad-alpha": ({ alpha }) => `Alfa debe estar entre 0 y 1, no ser ${exact(alpha)}.`,
  "bad-search-limit": ({ limit, value }) => `${limit} debe ser 0 o más, no ${exact(value)}.`,
  "search-task": ({ task }) => `El resultado de la tarea ${exact(task)} no es de ninguna tarea abierta; entregue cada resultado una vez.`,
  "search-candidate": ({ place }) => `El candidato ${exact(place)} no se midió para su dirección.`,
  "several-targets": () => "Indique una tolerancia, el máximo de capas o el tiempo más largo, y solo una de las tres cosas.",
  "contradictory-options": ({ option, other }) => `${option} y ${other} se excluyen. Quite uno de los dos.`,
  "printer-layers": ({ model, printer_min_mm, printer_max_mm, layer_min_mm, layer_max_mm }) =>
    `La ${model} imprime capas de ${exact(printer_min_mm)} a ${mm(printer_max_mm)}, no de ${exact(layer_min_mm)} a ${mm(layer_max_mm)}; ` +
    "quédese dentro de sus límites o elija otra impresora.",
  "printer-step": ({ model, printer_step_mm, step_mm }) =>
    `La ${model} se mueve en pasos de ${mm(printer_step_mm)}, y ${mm(step_mm)} no es un número entero de ellos; use un múltiplo de ${mm(printer_step_mm)}.`,
  "resin-printer": ({ format, model }) =>
    `Los archivos ${format} son para impresoras de filamento, y la ${model} imprime resina; quite la impresora o elija un formato que lea.`,
  "nozzle-without-filament": ({ formats }) =>
    `Una boquilla solo va con los formatos para impresoras de filamento: ${formats.join(", ")}; elija uno de ellos o quite la boquilla.`,
  "bad-nozzle": ({ nozzle_mm, least_mm, most_mm }) => `La boquilla debe medir de ${exact(least_mm)} a ${mm(most_mm)}, no ${mm(nozzle_mm)}.`,
  "nozzle-layers": ({ slicers, nozzle_mm, nozzle_min_mm, nozzle_max_mm, layer_min_mm, layer_max_mm }) =>
    `Con una boquilla de ${mm(nozzle_mm)}, ${either(slicers)} imprime capas de ${exact(nozzle_min_mm)} a ${mm(nozzle_max_mm)}, ` +
    `no de ${exact(layer_min_mm)} a ${mm(layer_max_mm)}; quédese dentro de sus límites o indique otra boquilla.`,
  "grid-bad-size": ({ width, height, max_side, max_pixels }) =>
    `Una máscara de ${count(width)} × ${count(height)} píxeles no es posible: puede haber de 1 a ${count(max_side)} por lado, y ${count(max_pixels)} en total.`,
  "grid-too-fine": ({ width, height, max_side, max_pixels }) =>
    `El suavizado pide ${count(width)} × ${count(height)} rayos, y puede haber ${count(max_side)} por lado, y ${count(max_pixels)} en total; elija un nivel más bajo.`,
  "model-too-large": ({ model_mm_x, model_mm_y, grid_mm_x, grid_mm_y, fitting_scale }) =>
    `El modelo mide ${exact(model_mm_x)} × ${mm(model_mm_y)}, pero la cuadrícula solo cubre ${exact(grid_mm_x)} × ${mm(grid_mm_y)}; cabe con una escala de ${exact(fitting_scale)}.`,
  "model-too-high": ({ model_mm_z, printer_mm_z, fitting_scale }) =>
    `El modelo tiene ${mm(model_mm_z)} de alto, pero la impresora solo imprime ${mm(printer_mm_z)}; cabe con una escala de ${exact(fitting_scale)}.`,
  "plate-empty": () => "No hay ningún modelo en la placa; añada uno.",
  "plate-without-size": () => "No se conoce el tamaño de la placa; elija una impresora, o indique los píxeles y su paso.",
  "bad-spacing": ({ spacing_mm }) => `La separación debe ser de 0 a 100 mm, no ${mm(spacing_mm)}.`,
  "bad-turn": ({ turn_deg }) => `Los modelos giran en pasos de 0, 15, 30, 45, 60, 90, 120 o 180°, no ${exact(turn_deg)}°.`,
  "plate-too-small": ({ model_number, size_mm, plate_mm }) =>
    `El modelo ${count(model_number)} mide ${exact(size_mm[0])} × ${mm(size_mm[1])}, y la placa ${exact(plate_mm[0])} × ${mm(plate_mm[1])}; cambie su escala, o elija otra orientación u otra impresora.`,
  "too-many-copies": ({ copies, most_copies }) =>
    `${count(copies)} copias son demasiadas para un trabajo, que tiene ${count(most_copies)} como máximo; haga varios trabajos.`,
  "plate-other-copies": ({ model_number, copies, places }) =>
    `El modelo ${count(model_number)} debe imprimirse ${count(copies)} veces y tiene ${count(places)} lugares; corrija uno de los dos, o distribuya la placa.`,
  "plate-gap": ({ plate_number }) => `No hay nada en la placa ${count(plate_number)}, pero sí en una posterior; numere las placas sin huecos.`,
  "plate-outside": ({ model_number, copy_number, plate_number }) =>
    `La copia ${count(copy_number)} del modelo ${count(model_number)} sobresale de la placa ${count(plate_number)}; muévala, o distribuya la placa.`,
  "plate-collision": ({ model_numbers, copy_numbers, plate_number }) =>
    `La copia ${count(copy_numbers[0])} del modelo ${count(model_numbers[0])} y la copia ${count(copy_numbers[1])} del modelo ${count(model_numbers[1])} se superponen en la placa ${count(plate_number)}; mueva una, o distribuya la placa.`,
  "plate-no-model": ({ model_number, models }) => `No hay modelo ${count(model_number)}; la placa tiene ${count(models)}.`,
  "no-such-plate": ({ plate_number, plates }) => `No hay placa ${count(plate_number)}; hay ${count(plates)}.`,
  "too-many-bins": ({ height_mm, bin_mm }) =>
    `${mm(height_mm)} en intervalos de ${mm(bin_mm)} son demasiados; elija un intervalo más grande.`,
  "not-whole-bins": ({ quantity, length_mm, bin_mm }) =>
    `${QUANTITIES[quantity]} de ${mm(length_mm)} no es un número entero de intervalos de ${mm(bin_mm)}; elija un intervalo que lo divida.`,
  "not-whole-steps": ({ quantity, length_mm, step_mm }) =>
    `${QUANTITIES[quantity]} de ${mm(length_mm)} no es un número entero de pasos de ${mm(step_mm)}; elija un múltiplo de ${mm(step_mm)}.`,
  "layer-range-upside-down": ({ layer_min_mm, layer_max_mm }) =>
    `El espesor de capa mínimo de ${mm(layer_min_mm)} supera al máximo de ${mm(layer_max_mm)}; reduzca uno o aumente el otro.`,
  "layer-range-empty": ({ layer_min_mm, layer_max_mm, step_mm }) =>
    `Ningún número entero de pasos de ${mm(step_mm)} está entre los espesores ${exact(layer_min_mm)} y ${mm(layer_max_mm)}; ` +
    "amplíe el intervalo o elija un paso más pequeño.",
  "layer-too-thick": ({ layer_mm, height_mm }) =>
    `Las capas de ${mm(layer_mm)} son demasiado gruesas para un modelo de ${mm(height_mm)} de alto.`,
  "layers-do-not-fit": ({ from_mm, to_mm, layer_min_mm, layer_max_mm }) =>
    `Las capas de ${exact(layer_min_mm)} a ${mm(layer_max_mm)} no suman la altura de ${exact(from_mm)} a ${mm(to_mm)}; ` +
    "amplíe el intervalo de espesores o mueva los planos.",
  "thicknesses-do-not-fit": ({ from_mm, to_mm, model_number, tolerance, thicknesses_mm, least_tolerance }) =>
    `Las capas de ${thicknesses_mm.map(mm).join(", ")} no llevan de z = ${exact(from_mm)} a ${mm(to_mm)} dentro de la tolerancia de ${exact(tolerance)}${model_number === null ? "" : ` en el modelo ${count(model_number)}`}; ` +
    (least_tolerance === null
      ? "añada un espesor o mueva los planos."
      : `aumente la tolerancia a ${exact(least_tolerance)} o añada un espesor.`),
  "too-few-thicknesses": ({ thicknesses, enough }) =>
    `Ningún plan dentro de la tolerancia tiene como máximo ${count(thicknesses)} espesores de capa; permita ${count(enough)} o aumente la tolerancia.`,
  "not-gradual": ({ change_mm, least_change_mm }) =>
    `Ningún plan dentro de la tolerancia cambia el espesor en ${mm(change_mm)} como máximo de capa a capa; permita cambios de ${mm(least_change_mm)} o aumente la tolerancia.`,
  "bad-range": ({ from_mm, to_mm }) =>
    `El intervalo de altura de ${exact(from_mm)} a ${mm(to_mm)} está vacío o se solapa con otro; indique intervalos ascendentes y separados.`,
  "bad-plane": ({ z_mm, height_mm }) => `No puede haber un plano a ${mm(z_mm)} en un modelo de ${mm(height_mm)} de alto.`,
  infeasible: ({ from_mm, to_mm, model_number, tolerance, layer_min_mm }, metric) =>
    `Ningún plan mantiene el error de cada capa${model_number === null ? "" : ` en el modelo ${count(model_number)}`} dentro de ${error(metric, tolerance)}: de z = ${exact(from_mm)} a ${mm(to_mm)} lo supera incluso una capa de ${mm(layer_min_mm)}.`,
  "out-of-reach": (detail) =>
    "layers" in detail
      ? `Ningún plan tiene como máximo ${count(detail.layers)} capas; hacen falta al menos ${count(detail.least_layers)}.`
      : `Ningún plan imprime en ${measure(detail.time_s, "s")} como máximo; hacen falta al menos ${measure(detail.least_time_s, "s")}.`,
  "no-plan": () => "Aún no hay plan; haga uno primero.",
  "memory-bound": ({ needed_bytes, allowed_bytes }) =>
    `Esto ocupa unos ${count(needed_bytes)} bytes de memoria, y se permiten ${count(allowed_bytes)}; permita más o elija píxeles mayores.`,
  "time-bound": ({ work, needed_s, allowed_s }) => {
    const [subject, way] = WORK[work];
    return `${subject} requiere unos ${count(needed_s)}\u00a0s de procesador y se permiten ${count(allowed_s)}; permita más${way}.`;
  },
  "no-layer": ({ layer, layers }) => `No hay capa ${count(layer)}; el plan tiene ${count(layers)}, desde 0.`,
  "no-hits": ({ pitch_mm }) =>
    `Ningún píxel de ${mm(pitch_mm)} toca el modelo, que es demasiado pequeño o fino para ellos; elija píxeles más pequeños.`,
  "too-many-facets": ({ facets, most }) => `${count(facets)} facetas son demasiadas; se pueden cortar ${count(most)} como máximo.`,
  "out-of-memory": ({ hits, needed_bytes }) =>
    `El modelo necesita ${count(needed_bytes)} bytes para ${count(hits)} puntos de superficie a esta resolución, más de los que hay; elija menos rayos.`,
  "no-gpu": ({ system }) => `No hay una GPU utilizable: ${ended(system)}`,
  "gpu-emulated": ({ adapter }) => `No hay una GPU utilizable: ${adapter} está emulada por software.`,
  "gpu-too-small": ({ facets, needed_bytes, limit_bytes }) =>
    `${counted(facets, FACETS)} necesitan un búfer de GPU de ${count(needed_bytes)} bytes, y esta GPU ofrece ${count(limit_bytes)}; use la CPU.`,
  "gpu-failed": ({ fault, system }) => `La GPU falló: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
  "all-black": () =>
    "Todas las máscaras son negras: el modelo no encierra nada que la mitad de una capa encuentre; revise el modelo o elija capas más finas.",
  "uniform-only": ({ format, others, best }) =>
    `Los archivos ${format} tienen un solo espesor para todas las capas, y este plan tiene varios; elija ${others.join(", ")} o ${inPlace(best, { count, mm })}.`,
  "printer-uniform-only": ({ model, best }) =>
    `La ${model} admite un solo espesor para todas las capas, y este plan tiene varios; elija ${inPlace(best, { count, mm })}.`,
  "weights-not-weights": () => "No es un archivo de pesos: no empieza por CUSPWT01, o está cortado.",
  "weights-other-mesh": ({ weights_facets, mesh_facets }) =>
    `Estos pesos son de otra malla, de ${counted(weights_facets, FACETS)}; esta tiene ${count(mesh_facets)}; ` +
    "píntela de nuevo o abra el modelo para el que se hicieron.",
  "weights-out-of-range": ({ facet, weight }) => `El peso de la faceta ${count(facet)} es ${exact(weight)}, y los pesos van de 0 a 1.`,
  "price-out-of-bounds": ({ field, value, least, most }) =>
    `${field} es ${exact(value)}, pero debe estar entre ${exact(least)} y ${exact(most)}; corrija los precios o el pedido.`,
  "bad-prices": ({ field }) =>
    `Los precios no pueden tener ese ${field}: una moneda son tres mayúsculas de ISO 4217, los tramos crecen y cada acabado tiene su propio nombre.`,
  "no-finish": ({ finish, known }) => `No hay acabado ${finish}; ${known.length > 0 ? `se conocen ${known.join(", ")}` : "los precios no nombran ninguno"}.`,
  "no-masks": ({ format }) =>
    `Los archivos ${format} contienen un modelo y sus capas, pero no máscaras; corte el modelo mismo en este formato o elija otro.`,
  "other-first-layer": ({ layer_mm, first_layer_mm }) =>
    `La primera capa de este plan mide ${mm(layer_mm)}, no ${mm(first_layer_mm)} como se indicó; el modelo es más bajo, así que elija una primera capa más fina.`,
  "archive-write": ({ system }) => `No se pudo escribir el archivo de impresión: ${ended(system)}`,
  cancelled: () => "Cancelado.",
  "bad-attribute": ({ attribute, value, known }) =>
    `El atributo ${attribute} no puede ser ${String(value)}${known === undefined ? "" : `; se conocen ${known.join(", ")}`}.`,
  "part-failed": ({ part, system }) => `No se pudo cargar una parte de la página: ${part} (${system}).`,
  "no-browser": () => "Aquí no hay navegador; llame a esto en la página.",
  "no-model": () => "Aún no hay modelo; abra uno primero.",
  "file-unreadable": () => "Quizá se movió, cambió o está bloqueado. Elíjalo de nuevo.",
  "bad-source": ({ given }) =>
    `No se puede leer un modelo de ${given}; pase un archivo, sus bytes o un flujo de ellos, una dirección, una respuesta o las posiciones de sus facetas.`,
  "bad-facets": ({ list, numbers, multiple_of }) => `La lista ${list} tiene ${count(numbers)} números y necesita un múltiplo de ${exact(multiple_of)}.`,
  "bad-index": ({ place, index, vertices }) =>
    `El índice en el lugar ${count(place)} es ${exact(index)}, que no es un vértice: hay ${count(vertices)}, desde 0.`,
  "bad-number": ({ argument, value }) => `El argumento ${argument} es ${String(value)} y debe ser un número entero desde 0.`,
  "dropped-link": () => "Esto es un enlace, no un archivo. Descargue el modelo y suelte el archivo aquí.",
  "folder-without-model": () => "La carpeta no contiene ningún archivo STL, 3MF u OBJ. Suelte la que tiene los modelos o un modelo.",
  "fetch-failed": (detail) =>
    "status" in detail ? `En esa dirección no había un archivo (HTTP ${detail.status}).` : `La dirección no respondió (${detail.system}).`,
  "worker-failed": ({ system }) =>
    `Recargue la página. Si no ayuda, avise a quien la administra: falta un script, o la política de la página no permite el worker. (${system})`,
  "start-failed": ({ system }) =>
    `Recargue la página. Si no ayuda, quizá este navegador es demasiado antiguo para WebAssembly. (${system})`,
  crash: ({ system }) =>
    `Quizá se agotó la memoria. Se ha reiniciado: inténtelo de nuevo, con menos rayos si el modelo es grande. (${system})`,
});
