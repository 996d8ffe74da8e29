/** Labels of offers. */

export const offers = {
  tolerance: "Tolerance {error}",
  layersFrom: "Layers from {thickness}",
  rays: "{count} rays",
  scale: "Scale to {height}",
  uniform: "Uniform layers of {thickness}",
  bestUniform: "Uniform layers of {thickness} ({layers|one:# layer|other:# layers})",
  images: "Save as images",
  floating: "Save it all the same",
  noPrinter: "Without a printer",
  parts: "They are parts of the model",
  unit: "It is in {unit|settings.units}",
  again: "Try again",
} as const;
