// Fetches the pictures of both sides as they change. Each side has one on its way at most, then the newest of those that came
// meanwhile, so that a slider that is drawn shows what it does. Where both sides show the same, it is fetched once.
import { SIDES } from "./dom.js";

export class Pictures {
  /** `arrived` is called with a side, its image, and a key that tells it from others. */
  constructor(address, arrived) {
    Object.assign(this, { address, arrived });
    this.shown = [null, null];
    this.images = [null, null];
    this.isFetching = [false, false];
  }

  /** Fetches what of a new state is not shown yet. */
  follow(state) {
    this.state = state;
    SIDES.forEach((_, side) => {
      const other = 1 - side;
      if (this.key(side) !== null && this.key(side) === this.shown[other]) this.take(side, this.shown[other], this.images[other]);
      else this.fetch(side).catch(() => {});
    });
  }

  /** Returns what tells a side's picture from others; null where there is none yet. */
  key(side) {
    const { number, spp, display } = this.state.sides[side];
    return spp === null ? null : `${number}/${spp}/${display}`;
  }

  async fetch(side) {
    const isOfBoth = () => this.key(0) === this.key(1);
    if (this.isFetching[side] || (side === 1 && isOfBoth())) return;
    this.isFetching[side] = true;
    try {
      for (let key = this.key(side); key !== null && key !== this.shown[side]; key = this.key(side)) {
        const answer = await fetch(this.address("picture", side, `&of=${encodeURIComponent(key)}`));
        if (answer.status !== 200) {
          // The settings have just changed again: an event says so, or has said so.
          if (key === this.key(side)) break;
          continue;
        }
        const image = await createImageBitmap(await answer.blob());
        SIDES.forEach((_, own) => {
          if (own === side || this.key(own) === key) this.take(own, key, image);
        });
      }
    } finally {
      this.isFetching[side] = false;
    }
  }

  take(side, key, image) {
    if (this.shown[side] === key) return;
    this.shown[side] = key;
    this.images[side] = image;
    this.arrived(side, image, key);
  }
}
