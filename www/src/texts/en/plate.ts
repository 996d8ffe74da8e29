/** The models on the plate, their copies and placements, and the plates. */

export const plate = () => ({
  plate: {
    add: "Add model",
    copies: "Copies",
    copiesOf: (name: string) => `Copies of ${name}`,
    fewer: "One fewer",
    more: "One more",
    arrange: "Arrange",
    title: "Models on the plate",
    remove: (name: string) => `Remove ${name}`,
    spacing: "Spacing (mm)",
    /** Label of the choice of turns about z. */
    turns: "Turns",
    turnless: "None",
    step: (degrees: string) => `Steps of ${degrees}°`,
    plate: (number: string, count: string) => `Plate ${number} of ${count}`,
    previous: "Previous plate",
    next: "Next plate",
    /** A copy's share of time and resin. */
    each: (time: string, resin: string) => `${time}, ${resin} each`,
    whole: (time: string, resin: string) => `All plates: ${time}, ${resin}`,
    all: "Download all plates",
    /** Number of problems not listed. */
    others: (count: string) => `And ${count} more.`,
    moved: "Copies stand where they were moved.",
  },
});

export type PlateTexts = ReturnType<typeof plate>;
