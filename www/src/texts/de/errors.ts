import type { UniformLayers } from "../../api/wire.js";
import type { Format } from "../format.js";
import { adviceOn, ended, FILE_KINDS, flatKind, STL_KEYWORDS, type ErrorSentences, type QuantityNouns, type StlNouns, type WorkWords } from "../sentences.js";
import { FACETS, FAULTS } from "./nouns.js";
import { readers } from "./readers.js";

const QUANTITIES: QuantityNouns = {
  pitch: "Der Pixelabstand",
  bin: "Die Höhe der Intervalle",
  step: "Der Motorschritt",
  layer: "Die Schichtdicke",
  "first-layer": "Die erste Schicht",
  "layer-min": "Die kleinste Schichtdicke",
  "layer-max": "Die größte Schichtdicke",
  tolerance: "Die Toleranz",
  "resin-layer": "Die Schichtdicke des Harzes",
  penetration: "Die Eindringtiefe",
  exposure: "Die Belichtung",
  "bottom-exposure": "Die Belichtung der Bodenschichten",
  wait: "Die Wartezeit zwischen Schichten",
  lift: "Die Hubhöhe",
  "lift-speed": "Die Hubgeschwindigkeit",
  "return-speed": "Die Rückfahrgeschwindigkeit",
  density: "Die Dichte des Harzes",
};

const WORK: WorkWords = {
  hits: ["Das Abtasten des Modells", ", oder wählen Sie größere Pixel"],
  layers: ["Die Planung", ", oder wählen Sie größere Höhenstufen oder weniger Dicken"],
  saliency: ["Die Suche nach Auffälligem", ", verzichten Sie darauf, oder geben Sie dem Modell weniger Dreiecke"],
  all: ["Dies", ""],
};

const EXPECTED: StlNouns = {
  ...STL_KEYWORDS,
  "facet-or-endsolid": "`facet` oder `endsolid`",
  "normal-number": "eine Zahl der Normalen",
  coordinate: "eine Koordinate",
};

const inPlace = (best: UniformLayers | null | undefined, { count, mm }: Pick<Format, "count" | "mm">): string =>
  best ? `${count(best.layers)} gleichmäßige Schichten von ${mm(best.layer_mm)}, die die Toleranz einhalten` : "gleichmäßige Schichten";

export const errors = ({ count, counted, exact, mm, measure, error, either }: Format): ErrorSentences => ({
  ...readers({ count }),
  "file-empty": () => "Die Datei ist leer; exportieren Sie das Modell noch einmal.",
  "unknown-file-kind": () => "Das ist kein Modell, das Cusp liest; exportieren Sie es als STL, 3MF oder OBJ.",
  "no-plate": ({ plate_number, plates }) => `Es gibt keine Platte ${count(plate_number)}: Die Datei hat ${count(plates)}.`,
  "other-file-kind": ({ kind }) =>
    flatKind(kind, { picture: "ein Bild", document: "ein Dokument", drawing: "eine Zeichnung" }, (noun) => `Das ist ${noun} (${FILE_KINDS[kind]}); Cusp öffnet STL, 3MF, OBJ und Druckdateien.`) ??
    `Das ist eine ${FILE_KINDS[kind]}-Datei, die Cusp nicht liest; ${adviceOn(kind, {
      model: "exportieren Sie das Modell als STL, 3MF oder OBJ",
      packed: "entpacken Sie sie, und öffnen Sie das Modell darin",
      page: "laden Sie das Modell selbst herunter; vielleicht verlangt die Adresse eine Anmeldung, oder sie führt zu einer Seite über das Modell",
    })}.`,
  "stl-truncated": (detail) =>
    "line" in detail
      ? `Das STL ist abgeschnitten: Es endet in Zeile ${count(detail.line)}, wo ${EXPECTED[detail.expected]} folgen müsste.`
      : `Das STL ist abgeschnitten: Sein Kopf kündigt ${counted(detail.declared_facets, FACETS)} an, wofür ${count(detail.expected_bytes)} Byte nötig sind, ` +
        `aber die Datei endet bei Byte ${count(detail.found_bytes)}; kopieren oder exportieren Sie sie noch einmal.`,
  "stl-wrong-facet-count": ({ declared_facets, found_facets }) =>
    `Die Zahl der Dreiecke stimmt nicht: Der Kopf kündigt bei Byte 80 ${counted(declared_facets, FACETS)} an, es folgen aber ${count(found_facets)}; exportieren Sie das Modell noch einmal.`,
  "stl-not-finite": (detail) =>
    "line" in detail
      ? `Zeile ${count(detail.line)}: \`${detail.text}\` ist keine endliche Zahl; exportieren Sie das Modell noch einmal.`
      : `Die Koordinate bei Byte ${count(detail.byte)} (Dreieck ${count(detail.facet)}) ist keine endliche Zahl; exportieren Sie das Modell noch einmal.`,
  "stl-syntax": ({ line, expected, found }) =>
    `Zeile ${count(line)}: ${EXPECTED[expected]} erwartet, \`${found}\` gefunden; exportieren Sie das Modell noch einmal.`,
  "stl-no-facets": () => "Das STL enthält keine Dreiecke; exportieren Sie das Modell noch einmal.",
  "mesh-no-area": ({ facets }) => `Keines der Dreiecke (${count(facets)}) hat eine Fläche; exportieren Sie das Modell noch einmal.`,
  "mesh-zero-height": () => "Das Modell hat keine Höhe; ist es flach, oder liegt es in der Ebene z = konstant?",
  "mesh-overflow": () => "Das Modell ist zu groß: Bei dieser Höhe misst es mehr als einen Kilometer; wählen Sie eine andere Einheit oder Höhe.",
  "bad-height": ({ height_mm }) => `Die Höhe muss größer als 0 sein, nicht ${mm(height_mm)}.`,
  "bad-rotation": () => "Die Drehung muss ein Quaternion x, y, z, w sein, dessen Länge nicht 0 ist.",
  "bad-length": ({ quantity, value, unit, least, most }, metric) =>
    `${QUANTITIES[quantity]} muss zwischen ${exact(least)} und ${measure(most, unit, metric)} liegen, nicht bei ${measure(value, unit, metric)}.`,
  "bad-time": ({ quantity, value_s, most_s }) => `${QUANTITIES[quantity]} muss zwischen 0 und ${measure(most_s, "s")} liegen, nicht bei ${measure(value_s, "s")}.`,
  "bad-exposures": ({ previous_mm, next_mm }) =>
    `Gemessene Belichtungen müssen nach der Dicke geordnet sein, jede dicker als die vorige; auf ${mm(previous_mm)} folgt aber ${mm(next_mm)}.`,
  "bad-growth": ({ least_mm, most_mm, value_mm }) =>
    `Das Wachstum eines Drucks muss zwischen ${exact(least_mm)} und ${mm(most_mm)} liegen, nicht bei ${mm(value_mm)}.`,
  "bad-options": ({ system }) => `Die Optionen lassen sich nicht lesen: ${ended(system)}`,
  "unknown-printer": ({ printer, similar, known }) =>
    `Unter den ${count(known)} bekannten Druckern ist kein ${printer}${similar.length === 0 ? "" : `; ähnlich sind ${similar.join(", ")}`}.`,
  "bad-printer": ({ printer, field }) => `Der Drucker ${printer} kann diesen Wert von ${field} nicht haben; berichtigen Sie seine Beschreibung.`,
  "printer-not-json": ({ system }) => `Diese Datei beschreibt keinen Drucker in JSON: ${ended(system)}`,
  "printer-too-long": ({ bytes, most_bytes }) => `Die Beschreibung eines Druckers hat höchstens ${count(most_bytes)} Byte, und diese Datei hat ${count(bytes)}; wählen Sie eine andere Datei.`,
  "pixels-without-pitch": () =>
    "Pixel und ihr Abstand in x und y gehören zusammen; geben Sie beides an, oder einen Abstand für x und y.",
  "bad-antialias": ({ antialias, known }) => `Die Kantenglättung hat die Stufen ${known.join(", ")}, nicht ${exact(antialias)}.`,
  "bad-size": ({ option, value_mm, least_mm, most_mm }) => `${option} muss zwischen ${mm(least_mm)} und ${mm(most_mm)} liegen, nicht bei ${mm(value_mm)}.`,
  "bad-weight-min": ({ weight_min }) => `Das kleinste Gewicht muss zwischen 0 und 1 liegen, nicht bei ${exact(weight_min)}.`,
  "bad-directions": ({ directions, most }) => `Eine Suche prüft 1 bis ${count(most)} Richtungen, nicht ${count(directions)}.`,
  "bad-limit": ({ limit, value, least, most }) => `${limit} muss zwischen ${exact(least)} und ${exact(most)} liegen, nicht bei ${exact(value)}.`,
  "bad-alpha": ({ alpha }) => `Alpha muss zwischen 0 und 1 liegen, nicht bei ${exact(alpha)}.`,
  "bad-search-limit": ({ limit, value }) => `${limit} muss 0 oder mehr sein, nicht ${exact(value)}.`,
  "search-task": ({ task }) => `Das Ergebnis der Aufgabe ${exact(task)} gehört zu keiner offenen Aufgabe; geben Sie jedes Ergebnis einmal ab.`,
  "search-candidate": ({ place }) => `Kandidat ${exact(place)} wurde nicht für seine Richtung gemessen.`,
  "several-targets": () => "Geben Sie eine Toleranz, die höchste Zahl von Schichten oder die längste Zeit an, und nur eines davon.",
  "contradictory-options": ({ option, other }) => `${option} und ${other} schließen einander aus. Lassen Sie eins davon weg.`,
  "printer-layers": ({ model, printer_min_mm, printer_max_mm, layer_min_mm, layer_max_mm }) =>
    `Der ${model} druckt Schichten von ${exact(printer_min_mm)} bis ${mm(printer_max_mm)}, nicht von ${exact(layer_min_mm)} bis ${mm(layer_max_mm)}; ` +
    "bleiben Sie in diesen Grenzen, oder wählen Sie einen anderen Drucker.",
  "printer-step": ({ model, printer_step_mm, step_mm }) =>
    `Der ${model} fährt in Schritten von ${mm(printer_step_mm)}, und ${mm(step_mm)} sind keine ganze Zahl davon; wählen Sie ein Vielfaches von ${mm(printer_step_mm)}.`,
  "resin-printer": ({ format, model }) =>
    `${format}-Dateien sind für Filamentdrucker, und der ${model} druckt Harz; lassen Sie den Drucker weg, oder wählen Sie ein Format, das er liest.`,
  "nozzle-without-filament": ({ formats }) =>
    `Eine Düse gehört nur zu den Formaten für Filamentdrucker: ${formats.join(", ")}; wählen Sie eins davon, oder lassen Sie die Düse weg.`,
  "bad-nozzle": ({ nozzle_mm, least_mm, most_mm }) => `Die Düse muss ${exact(least_mm)} bis ${mm(most_mm)} weit sein, nicht ${mm(nozzle_mm)}.`,
  "nozzle-layers": ({ slicers, nozzle_mm, nozzle_min_mm, nozzle_max_mm, layer_min_mm, layer_max_mm }) =>
    `Durch eine Düse von ${mm(nozzle_mm)} druckt ${either(slicers)} Schichten von ${exact(nozzle_min_mm)} bis ${mm(nozzle_max_mm)}, ` +
    `nicht von ${exact(layer_min_mm)} bis ${mm(layer_max_mm)}; bleiben Sie in diesen Grenzen, oder nennen Sie eine andere Düse.`,
  "grid-bad-size": ({ width, height, max_side, max_pixels }) =>
    `Eine Maske von ${count(width)} × ${count(height)} Pixeln ist nicht möglich: je Seite 1 bis ${count(max_side)}, insgesamt höchstens ${count(max_pixels)}.`,
  "grid-too-fine": ({ width, height, max_side, max_pixels }) =>
    `Die Kantenglättung verlangt ${count(width)} × ${count(height)} Strahlen, möglich sind ${count(max_side)} je Seite und ${count(max_pixels)} insgesamt; wählen Sie eine niedrigere Stufe.`,
  "model-too-large": ({ model_mm_x, model_mm_y, grid_mm_x, grid_mm_y, fitting_scale }) =>
    `Das Modell misst ${exact(model_mm_x)} × ${mm(model_mm_y)}, das Bild des Druckers nur ${exact(grid_mm_x)} × ${mm(grid_mm_y)}; mit dem Maßstab ${exact(fitting_scale)} passt es.`,
  "model-too-high": ({ model_mm_z, printer_mm_z, fitting_scale }) =>
    `Das Modell ist ${mm(model_mm_z)} hoch, der Drucker druckt aber nur ${mm(printer_mm_z)}; mit dem Maßstab ${exact(fitting_scale)} passt es.`,
  "plate-empty": () => "Auf der Platte steht kein Modell; fügen Sie eines hinzu.",
  "plate-without-size": () => "Die Größe der Platte ist nicht bekannt; wählen Sie einen Drucker, oder geben Sie Pixel und Pixelabstand an.",
  "bad-spacing": ({ spacing_mm }) => `Der Abstand muss 0 bis 100 mm sein, nicht ${mm(spacing_mm)}.`,
  "bad-turn": ({ turn_deg }) => `Modelle drehen sich in Schritten von 0, 15, 30, 45, 60, 90, 120 oder 180°, nicht ${exact(turn_deg)}°.`,
  "plate-too-small": ({ model_number, size_mm, plate_mm }) =>
    `Modell ${count(model_number)} misst ${exact(size_mm[0])} × ${mm(size_mm[1])}, die Platte ${exact(plate_mm[0])} × ${mm(plate_mm[1])}; skalieren Sie es, oder wählen Sie eine andere Orientierung oder einen anderen Drucker.`,
  "too-many-copies": ({ copies, most_copies }) =>
    `${count(copies)} Kopien sind zu viele für einen Auftrag, der höchstens ${count(most_copies)} hat; machen Sie mehrere Aufträge daraus.`,
  "plate-other-copies": ({ model_number, copies, places }) =>
    `Modell ${count(model_number)} soll ${count(copies)}-mal gedruckt werden und hat ${count(places)} Plätze; berichtigen Sie eines davon, oder ordnen Sie die Platte an.`,
  "plate-gap": ({ plate_number }) => `Auf Platte ${count(plate_number)} steht nichts, aber auf einer danach; nummerieren Sie Platten ohne Lücken.`,
  "plate-outside": ({ model_number, copy_number, plate_number }) =>
    `Kopie ${count(copy_number)} von Modell ${count(model_number)} ragt über Platte ${count(plate_number)} hinaus; verschieben Sie sie, oder ordnen Sie die Platte an.`,
  "plate-collision": ({ model_numbers, copy_numbers, plate_number }) =>
    `Kopie ${count(copy_numbers[0])} von Modell ${count(model_numbers[0])} und Kopie ${count(copy_numbers[1])} von Modell ${count(model_numbers[1])} überschneiden sich auf Platte ${count(plate_number)}; verschieben Sie eine, oder ordnen Sie die Platte an.`,
  "plate-no-model": ({ model_number, models }) => `Es gibt kein Modell ${count(model_number)}; die Platte hat ${count(models)}.`,
  "no-such-plate": ({ plate_number, plates }) => `Es gibt keine Platte ${count(plate_number)}; es sind ${count(plates)}.`,
  "too-many-bins": ({ height_mm, bin_mm }) =>
    `${mm(height_mm)} in Intervallen von ${mm(bin_mm)} sind zu viele; wählen Sie ein größeres Intervall.`,
  "not-whole-bins": ({ quantity, length_mm, bin_mm }) =>
    `${QUANTITIES[quantity]} von ${mm(length_mm)} ist keine ganze Zahl von Intervallen zu ${mm(bin_mm)}; wählen Sie ein Intervall, das darin aufgeht.`,
  "not-whole-steps": ({ quantity, length_mm, step_mm }) =>
    `${QUANTITIES[quantity]} von ${mm(length_mm)} ist keine ganze Zahl von Schritten zu ${mm(step_mm)}; wählen Sie ein Vielfaches von ${mm(step_mm)}.`,
  "layer-range-upside-down": ({ layer_min_mm, layer_max_mm }) =>
    `Die kleinste Schichtdicke von ${mm(layer_min_mm)} ist mehr als die größte von ${mm(layer_max_mm)}; verringern Sie die eine, oder erhöhen Sie die andere.`,
  "layer-range-empty": ({ layer_min_mm, layer_max_mm, step_mm }) =>
    `Keine ganze Zahl von Schritten zu ${mm(step_mm)} liegt zwischen den Schichtdicken ${exact(layer_min_mm)} und ${mm(layer_max_mm)}; ` +
    "erweitern Sie den Bereich, oder wählen Sie einen kleineren Schritt.",
  "layer-too-thick": ({ layer_mm, height_mm }) => `Schichten von ${mm(layer_mm)} sind zu dick für ein Modell von ${mm(height_mm)} Höhe.`,
  "layers-do-not-fit": ({ from_mm, to_mm, layer_min_mm, layer_max_mm }) =>
    `Schichten von ${exact(layer_min_mm)} bis ${mm(layer_max_mm)} ergeben nicht die Höhe von ${exact(from_mm)} bis ${mm(to_mm)}; ` +
    "erweitern Sie den Bereich der Dicken, oder verschieben Sie die Ebenen.",
  "thicknesses-do-not-fit": ({ from_mm, to_mm, model_number, tolerance, thicknesses_mm, least_tolerance }) =>
    `Schichten von ${thicknesses_mm.map(mm).join(", ")} führen nicht innerhalb der Toleranz von ${exact(tolerance)}${model_number === null ? "" : ` an Modell ${count(model_number)}`} von z = ${exact(from_mm)} bis ${mm(to_mm)}; ` +
    (least_tolerance === null
      ? "fügen Sie eine Dicke hinzu, oder verschieben Sie die Ebenen."
      : `erhöhen Sie die Toleranz auf ${exact(least_tolerance)}, oder fügen Sie eine Dicke hinzu.`),
  "too-few-thicknesses": ({ thicknesses, enough }) =>
    `Kein Plan innerhalb der Toleranz kommt mit höchstens ${count(thicknesses)} Schichtdicken aus; erlauben Sie ${count(enough)}, oder erhöhen Sie die Toleranz.`,
  "not-gradual": ({ change_mm, least_change_mm }) =>
    `Kein Plan innerhalb der Toleranz ändert die Schichtdicke von Schicht zu Schicht um höchstens ${mm(change_mm)}; erlauben Sie Änderungen von ${mm(least_change_mm)}, oder erhöhen Sie die Toleranz.`,
  "bad-range": ({ from_mm, to_mm }) =>
    `Der Höhenbereich von ${exact(from_mm)} bis ${mm(to_mm)} ist leer oder überlappt einen anderen; geben Sie Bereiche aufsteigend und getrennt an.`,
  "bad-plane": ({ z_mm, height_mm }) => `Bei ${mm(z_mm)} kann in einem Modell von ${mm(height_mm)} Höhe keine Ebene liegen.`,
  infeasible: ({ from_mm, to_mm, model_number, tolerance, layer_min_mm }, metric) =>
    `Kein Plan hält den Fehler jeder Schicht${model_number === null ? "" : ` an Modell ${count(model_number)}`} unter ${error(metric, tolerance)}: Von z = ${exact(from_mm)} bis ${mm(to_mm)} überschreitet ihn selbst eine Schicht von ${mm(layer_min_mm)}.`,
  "out-of-reach": (detail) =>
    "layers" in detail
      ? `Kein Plan hat höchstens ${count(detail.layers)} Schichten; mindestens ${count(detail.least_layers)} sind nötig.`
      : `Kein Plan druckt in höchstens ${measure(detail.time_s, "s")}; mindestens ${measure(detail.least_time_s, "s")} sind nötig.`,
  "no-plan": () => "Es gibt noch keinen Plan; erstellen Sie zuerst einen.",
  "memory-bound": ({ needed_bytes, allowed_bytes }) =>
    `Das braucht etwa ${count(needed_bytes)} Byte Speicher, und ${count(allowed_bytes)} sind erlaubt; erlauben Sie mehr, oder wählen Sie größere Pixel.`,
  "time-bound": ({ work, needed_s, allowed_s }) => {
    const [subject, way] = WORK[work];
    return `${subject} braucht etwa ${count(needed_s)}\u00a0s Rechenzeit, und ${count(allowed_s)} sind erlaubt; erlauben Sie mehr${way}.`;
  },
  "no-layer": ({ layer, layers }) => `Es gibt keine Schicht ${count(layer)}; der Plan hat ${count(layers)}, gezählt ab 0.`,
  "no-hits": ({ pitch_mm }) =>
    `Kein Pixel von ${mm(pitch_mm)} trifft das Modell, das dafür zu klein oder zu dünn ist; wählen Sie kleinere Pixel.`,
  "too-many-facets": ({ facets, most }) => `${count(facets)} Dreiecke sind zu viele; höchstens ${count(most)} lassen sich schneiden.`,
  "out-of-memory": ({ hits, needed_bytes }) =>
    `Das Modell braucht ${count(needed_bytes)} Byte für ${count(hits)} Oberflächenpunkte bei dieser Auflösung, mehr als vorhanden sind; wählen Sie weniger Strahlen.`,
  "no-gpu": ({ system }) => `Keine nutzbare GPU: ${ended(system)}`,
  "gpu-emulated": ({ adapter }) => `Keine nutzbare GPU: ${adapter} wird von Software nachgebildet.`,
  "gpu-too-small": ({ facets, needed_bytes, limit_bytes }) =>
    `${counted(facets, FACETS)} brauchen einen GPU-Puffer von ${count(needed_bytes)} Byte, und diese GPU bietet ${count(limit_bytes)}; benutzen Sie die CPU.`,
  "gpu-failed": ({ fault, system }) => `Die GPU hat versagt: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
  "all-black": () =>
    "Alle Masken sind schwarz: Das Modell umschließt nichts, was die Mitte einer Schicht trifft; prüfen Sie das Modell, oder wählen Sie dünnere Schichten.",
  "uniform-only": ({ format, others, best }) =>
    `${format}-Dateien haben eine Dicke für alle Schichten, und dieser Plan hat mehrere; wählen Sie ${others.join(", ")} oder ${inPlace(best, { count, mm })}.`,
  "printer-uniform-only": ({ model, best }) =>
    `Der ${model} nimmt eine Dicke für alle Schichten, und dieser Plan hat mehrere; wählen Sie ${inPlace(best, { count, mm })}.`,
  "weights-not-weights": () => "Das ist keine Datei mit Gewichten: Sie beginnt nicht mit CUSPWT01 oder ist abgeschnitten.",
  "weights-other-mesh": ({ weights_facets, mesh_facets }) =>
    `Diese Gewichte gehören zu einem anderen Netz aus ${count(weights_facets)} Dreiecken; dieses hat ${count(mesh_facets)}; ` +
    "bemalen Sie es noch einmal, oder öffnen Sie das Modell, für das sie gemacht wurden.",
  "weights-out-of-range": ({ facet, weight }) => `Das Gewicht von Dreieck ${count(facet)} ist ${exact(weight)}; Gewichte liegen zwischen 0 und 1.`,
  "price-out-of-bounds": ({ field, value, least, most }) =>
    `${field} ist ${exact(value)}, muss aber zwischen ${exact(least)} und ${exact(most)} liegen; berichtigen Sie Preise oder Bestellung.`,
  "bad-prices": ({ field }) =>
    `Preise können dieses ${field} nicht haben: Eine Währung hat drei Großbuchstaben nach ISO 4217, Mengenstaffeln steigen, und jede Nachbearbeitung hat ihren eigenen Namen.`,
  "no-finish": ({ finish, known }) => `Es gibt keine Nachbearbeitung ${finish}; ${known.length > 0 ? `bekannt sind ${known.join(", ")}` : "die Preise nennen keine"}.`,
  "no-masks": ({ format }) =>
    `${format}-Dateien enthalten ein Modell und seine Schichten, aber keine Masken; schneiden Sie das Modell selbst in dieses Format, oder wählen Sie ein anderes.`,
  "other-first-layer": ({ layer_mm, first_layer_mm }) =>
    `Die erste Schicht dieses Plans ist ${mm(layer_mm)} dick, nicht ${mm(first_layer_mm)} wie eingestellt; das Modell ist niedriger, wählen Sie also eine dünnere erste Schicht.`,
  "archive-write": ({ system }) => `Die Druckdatei ließ sich nicht schreiben: ${ended(system)}`,
  cancelled: () => "Abgebrochen.",
  "bad-attribute": ({ attribute, value, known }) =>
    `Das Attribut ${attribute} kann nicht ${String(value)} sein${known === undefined ? "" : `; bekannt sind ${known.join(", ")}`}.`,
  "part-failed": ({ part, system }) => `Ein Teil der Seite ließ sich nicht laden: ${part} (${system}).`,
  "no-browser": () => "Hier ist kein Browser; rufen Sie das auf der Seite auf.",
  "no-model": () => "Es gibt noch kein Modell; öffnen Sie zuerst eines.",
  "file-unreadable": () => "Vielleicht wurde die Datei verschoben, geändert oder gesperrt. Wählen Sie sie noch einmal.",
  "bad-source": ({ given }) =>
    `Aus ${given} lässt sich kein Modell lesen; übergeben Sie eine Datei, ihre Bytes oder einen Strom davon, eine Adresse, eine Antwort oder die Koordinaten seiner Dreiecke.`,
  "bad-facets": ({ list, numbers, multiple_of }) => `Die Liste ${list} hat ${count(numbers)} Zahlen und braucht ein Vielfaches von ${exact(multiple_of)}.`,
  "bad-index": ({ place, index, vertices }) =>
    `Der Index an Stelle ${count(place)} ist ${exact(index)} und keine Ecke: Es gibt ${count(vertices)}, ab 0.`,
  "bad-number": ({ argument, value }) => `Das Argument ${argument} ist ${String(value)} und muss eine ganze Zahl ab 0 sein.`,
  "dropped-link": () => "Das ist ein Link, keine Datei. Laden Sie das Modell herunter, und ziehen Sie die Datei hierher.",
  "folder-without-model": () => "Der Ordner enthält keine STL-, 3MF- oder OBJ-Datei. Ziehen Sie den mit den Modellen hierher oder ein Modell selbst.",
  "fetch-failed": (detail) =>
    "status" in detail ? `Unter dieser Adresse kam keine Datei (HTTP ${detail.status}).` : `Die Adresse hat nicht geantwortet (${detail.system}).`,
  "worker-failed": ({ system }) =>
    `Laden Sie die Seite neu. Hilft das nicht, sagen Sie es ihrem Betreiber: Ein Skript fehlt, oder die Richtlinie der Seite verbietet den Worker. (${system})`,
  "start-failed": ({ system }) => `Laden Sie die Seite neu. Hilft das nicht, ist dieser Browser vielleicht zu alt für WebAssembly. (${system})`,
  crash: ({ system }) =>
    `Vielleicht reichte der Speicher nicht. Er ist neu gestartet: Versuchen Sie es noch einmal, bei einem großen Modell mit weniger Strahlen. (${system})`,
});
