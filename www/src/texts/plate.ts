/** The models on the plate, their copies and placements, and the plates. */

export const plate = {
  plate: {
    add: "Add model",
    copies: "Copies",
    copiesOf: "Copies of {name}",
    fewer: "One fewer",
    more: "One more",
    arrange: "Arrange",
    title: "Models on the plate",
    /** Shown without a printer. */
    usual: "The plate is taken to be {size}\u00a0mm; choose your printer for its own.",
    remove: "Remove {name}",
    spacing: "Spacing (mm)",
    /** Label of the choice of turns about z. */
    turns: "Turns",
    turnless: "None",
    step: "Steps of {degrees}°",
    plate: "Plate {number} of {count}",
    previous: "Previous plate",
    next: "Next plate",
    /** A copy's share of time and resin. */
    each: "{time}, {resin} each",
    whole: "All plates: {time}, {resin}",
    all: "Download all plates",
    /** Number of problems not listed. */
    others: "And {count} more.",
    moved: "Copies stand where they were moved.",
  },
} as const;
