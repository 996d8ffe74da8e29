/** A typed array that grows by doubling. */
export class Growing<T extends Float32Array | Uint32Array> {
  length = 0;
  #array: T;
  readonly #make: (length: number) => T;

  constructor(make: (length: number) => T) {
    this.#make = make;
    this.#array = make(1024);
  }

  push(a: number, b: number, c: number): void {
    if (this.length + 3 > this.#array.length) {
      const larger = this.#make(2 * this.#array.length);
      larger.set(this.#array);
      this.#array = larger;
    }
    this.#array[this.length++] = a;
    this.#array[this.length++] = b;
    this.#array[this.length++] = c;
  }

  done(): T {
    return this.#array.slice(0, this.length) as T;
  }
}
