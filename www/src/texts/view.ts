/** The region of the 3-D view; what is in it is said by `viewing.ts`. */
export const view = {
  view: {
    region: "The model in three dimensions",
    title: "Model",
  },
} as const;
