// Pointers, wheel and keys on the picture and its wipe: drag to move, pinch or wheel to zoom, click to keep a pixel.
import { find } from "./dom.js";

/** A pointer that has moved less than this, in screen pixels, has clicked. */
const STILL = 4;

export function followPointer(picture, stage) {
  const { canvas, wipe } = picture;
  const pointers = new Map();
  let moved = 0;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (pointers.size === 0) moved = 0;
    pointers.set(event.pointerId, place(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = place(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      if (!picture.isKept) picture.point(picture.pixelAt(now));
      return;
    }
    const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    pointers.set(event.pointerId, now);
    moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
    if (others.length === 1) {
      const [other] = others;
      const distance = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]);
      picture.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
      if (distance(before) > 0) picture.zoom(distance(now) / distance(before), now.map((value, i) => (value + other[i]) / 2));
    } else if (others.length === 0 && moved >= STILL) {
      picture.pan(now[0] - before[0], now[1] - before[1]);
    }
  });
  const release = (event) => {
    const at = pointers.get(event.pointerId);
    pointers.delete(event.pointerId);
    if (event.type !== "pointerup" || !at || moved >= STILL || pointers.size > 0) return;
    const pixel = picture.pixelAt(at);
    const isSame = picture.isKept && String(pixel) === String(picture.cross);
    picture.point(pixel, !isSame);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
    // Two fingers on a touchpad come as a wheel with Ctrl, in small steps.
    picture.zoomBy(-lines / (event.ctrlKey ? 20 : 120), place(event));
  }, { passive: false });

  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 10 : 1;
    const keys = {
      ArrowLeft: () => picture.step(-far, 0),
      ArrowRight: () => picture.step(far, 0),
      ArrowUp: () => picture.step(0, -far),
      ArrowDown: () => picture.step(0, far),
      "+": () => picture.zoomBy(2),
      "=": () => picture.zoomBy(2),
      "-": () => picture.zoomBy(-2),
      0: () => picture.fit(),
      1: () => picture.one(),
      Escape: () => picture.point(null, false),
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });

  wipe.addEventListener("pointerdown", (event) => wipe.setPointerCapture(event.pointerId));
  wipe.addEventListener("pointermove", (event) => {
    if (!wipe.hasPointerCapture(event.pointerId)) return;
    const box = stage.getBoundingClientRect();
    picture.setWipe((event.clientX - box.left) / box.width);
  });
  wipe.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 0.1 : 0.02;
    const to = {
      ArrowLeft: picture.part - step, ArrowDown: picture.part - step,
      ArrowRight: picture.part + step, ArrowUp: picture.part + step,
      PageDown: picture.part - 0.1, PageUp: picture.part + 0.1, Home: 0, End: 1,
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    picture.setWipe(to);
  });

  find("zoom-in").addEventListener("click", () => picture.zoomBy(2));
  find("zoom-out").addEventListener("click", () => picture.zoomBy(-2));
  find("zoom-fit").addEventListener("click", () => picture.fit());
  find("zoom-one").addEventListener("click", () => picture.one());
}
