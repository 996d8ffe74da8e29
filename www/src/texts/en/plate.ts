/** The models on the plate: their copies, their places and the plates. */

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
    /** Names the choice of turns about z. */
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
    /** How many problems are not listed. */
    others: (count: string) => `And ${count} more.`,
    moved: "Copies stand where they were moved.",
  },
});

export type PlateTexts = ReturnType<typeof plate>;
