/** What draws pictures of the model, fetched with the first of them. */
import { fetched } from "./fetched.js";

export const fetchPictures = fetched(() => import("../../view/scene/thumbnails.js"));
