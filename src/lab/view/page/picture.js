// The picture: two images in one frame with a wipe between them, zoom, and a crosshair on a pixel.

/** Steps of the zoom, and its ends in picture pixels a screen pixel. */
const STEP = 1.25;
const FARTHEST = 0.05;
const NEAREST = 400;
/** From this size on a pixel gets an outline. */
const OUTLINED = 6;

export class Picture {
  constructor(canvas, wipe, output) {
    Object.assign(this, { canvas, wipe, output });
    // A screen with wider primaries shows all colours of a picture that has them.
    const colorSpace = matchMedia("(color-gamut: p3)").matches ? "display-p3" : "srgb";
    this.context = canvas.getContext("2d", { colorSpace });
    this.images = [null, null];
    this.frame = [0, 0];
    this.isFitted = true;
    this.scale = 1;
    this.corner = [0, 0];
    this.part = 0.5;
    this.cross = null;
    this.isKept = false;
    this.onpixel = () => {};
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.setWipe(0.5);
  }

  get size() {
    return [this.canvas.clientWidth, this.canvas.clientHeight];
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    [this.canvas.width, this.canvas.height] = this.size.map((side) => Math.round(side * ratio));
    if (this.isFitted) this.fit();
    // At once: a canvas is empty after a change of its size.
    this.drawNow();
  }

  setFrame(width, height) {
    if (this.frame[0] === width && this.frame[1] === height) return;
    this.frame = [width, height];
    this.fit();
  }

  setImage(side, image) {
    this.images[side] = image;
    this.draw();
  }

  /** Shows the whole picture as large as it fits. */
  fit() {
    const [width, height] = this.size;
    if (!this.frame[0] || !width) return;
    this.scale = Math.min(width / this.frame[0], height / this.frame[1]);
    this.corner = [(width - this.scale * this.frame[0]) / 2, (height - this.scale * this.frame[1]) / 2];
    this.isFitted = true;
    this.draw();
  }

  /** Zooms by a factor about a place of the canvas, or about the crosshair. */
  zoom(factor, at = this.middle()) {
    const scale = Math.min(Math.max(this.scale * factor, FARTHEST), NEAREST);
    this.corner = this.corner.map((corner, i) => at[i] - ((at[i] - corner) * scale) / this.scale);
    this.scale = scale;
    this.isFitted = false;
    this.draw();
  }

  zoomBy(steps, at) {
    this.zoom(STEP ** steps, at);
  }

  /** Shows a pixel of the picture as one of the screen. */
  one() {
    this.zoom(1 / (window.devicePixelRatio || 1) / this.scale);
  }

  pan(x, y) {
    this.corner = [this.corner[0] + x, this.corner[1] + y];
    this.isFitted = false;
    this.draw();
  }

  middle() {
    return this.cross ? this.toCanvas(this.cross.map((place) => place + 0.5)) : this.size.map((side) => side / 2);
  }

  toCanvas(place) {
    return place.map((value, i) => this.corner[i] + value * this.scale);
  }

  /** Returns the pixel at a place of the canvas; null outside the picture. */
  pixelAt(at) {
    const place = at.map((value, i) => Math.floor((value - this.corner[i]) / this.scale));
    return place.every((value, i) => value >= 0 && value < this.frame[i]) ? place : null;
  }

  /** Moves the crosshair to a pixel. */
  point(pixel, isKept = this.isKept) {
    this.isKept = isKept && pixel !== null;
    if (String(this.cross) === String(pixel)) return this.draw();
    this.cross = pixel;
    this.draw();
    if (pixel) this.onpixel();
  }

  /** Moves the crosshair by pixels, and the picture where it would leave the canvas. */
  step(x, y) {
    const start = this.cross ?? this.frame.map((side) => Math.floor(side / 2));
    const next = [start[0] + x, start[1] + y].map((value, i) => Math.min(Math.max(value, 0), this.frame[i] - 1));
    this.point(this.cross ? next : start, true);
    const at = this.middle();
    const beyond = at.map((value, i) => Math.min(0, value - 8) + Math.max(0, value + 8 - this.size[i]));
    if (beyond.some((value) => value !== 0)) this.pan(-beyond[0], -beyond[1]);
  }

  /** Returns the side that shows the crosshair's pixel. */
  sideOfCross() {
    return this.middle()[0] < this.part * this.size[0] ? 0 : 1;
  }

  setWipe(part) {
    this.part = Math.min(Math.max(part, 0), 1);
    this.wipe.style.left = `${100 * this.part}%`;
    this.wipe.setAttribute("aria-valuenow", Math.round(100 * this.part));
    this.wipe.setAttribute("aria-valuetext", `A ${Math.round(100 * this.part)} %, B ${Math.round(100 - 100 * this.part)} %`);
    this.draw();
  }

  draw() {
    if (this.isAwaited) return;
    this.isAwaited = true;
    requestAnimationFrame(() => {
      this.isAwaited = false;
      this.drawNow();
    });
  }

  drawNow() {
    const { context } = this;
    const ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const [width, height] = this.size;
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = this.scale * ratio < 1;
    context.imageSmoothingQuality = "high";
    const edge = this.part * width;
    [[0, edge], [edge, width - edge]].forEach(([left, wide], side) => {
      const image = this.images[side];
      if (!image || wide <= 0) return;
      context.save();
      context.beginPath();
      context.rect(left, 0, wide, height);
      context.clip();
      context.drawImage(image, this.corner[0], this.corner[1], this.frame[0] * this.scale, this.frame[1] * this.scale);
      context.restore();
    });
    if (this.cross) this.drawCross(context);
    this.output.textContent = `${this.scale >= 10 ? Math.round(this.scale) : Number(this.scale.toPrecision(2))} × `;
  }

  drawCross(context) {
    const [x, y] = this.toCanvas(this.cross);
    const [cx, cy] = this.middle();
    const half = Math.max(this.scale, OUTLINED) / 2;
    for (const [color, wide] of [["#000", 3], [this.isKept ? "#ffd400" : "#fff", 1]]) {
      context.strokeStyle = color;
      context.lineWidth = wide;
      context.strokeRect(this.scale < OUTLINED ? cx - half : x, this.scale < OUTLINED ? cy - half : y, 2 * half, 2 * half);
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(cx + dx * (half + 3), cy + dy * (half + 3));
        context.lineTo(cx + dx * (half + 11), cy + dy * (half + 11));
      }
      context.stroke();
    }
  }
}
