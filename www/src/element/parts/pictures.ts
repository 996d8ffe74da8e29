/** Code that draws thumbnails of the model, fetched on first use. */
import { fetched } from "./fetched.js";

export const fetchPictures = fetched(() => import("../../view/scene/thumbnails.js"));
