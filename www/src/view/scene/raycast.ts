/** Where a ray meets a model and what lies nearest to a point: through a hierarchy of bounding boxes. */
import { BufferAttribute, BufferGeometry, DoubleSide, Ray, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Triple } from "./pose.js";

export interface RayHit {
  readonly facet: number;
  readonly point: Triple;
}

const tripleOf = ({ x, y, z }: Vector3): Triple => [x, y, z];

export class Raycast {
  readonly #tree: MeshBVH;

  /** @param positions nine numbers a facet, mm; at least one facet. Takes about a microsecond a facet. */
  constructor(positions: Float32Array) {
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
    // Facets keep their numbers.
    this.#tree = new MeshBVH(geometry, { indirect: true });
  }

  /** What a ray first meets from either side; `null` if nothing. */
  cast(ray: Ray): RayHit | null {
    const hit = this.#tree.raycastFirst(ray, DoubleSide);
    return hit === null || hit.faceIndex == null ? null : { facet: hit.faceIndex, point: tripleOf(hit.point) };
  }

  /** The point of the model nearest to this one, if it is no farther away than that. */
  nearest(point: Triple, within_mm: number): RayHit | null {
    const found = this.#tree.closestPointToPoint(new Vector3(...point), undefined, 0, within_mm);
    return found === null ? null : { facet: found.faceIndex, point: tripleOf(found.point) };
  }
}
