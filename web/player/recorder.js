// Saving of a flight as GIF or video.

import { applyPalette, GIFEncoder, quantize } from "gifenc";

const WIDTH = 560, HEIGHT = 360;  // px
const RATE = 15;  // frames per second
const LONGEST = 20;  // s; a longer flight plays faster

/** Draw a flight frame by frame; returns the bytes of a GIF. */
export function makeGif(scene, begin, end) {
  const speed = Math.max(1, (end - begin) / LONGEST);
  const frames = Math.max(2, Math.round((end - begin) / speed * RATE) + 1);
  const encoder = GIFEncoder();
  const context = scene.renderer.getContext();
  const pixels = new Uint8Array(4 * WIDTH * HEIGHT), upright = new Uint8Array(4 * WIDTH * HEIGHT);
  scene.setSize(WIDTH, HEIGHT, 1);
  try {
    for (let i = 0; i < frames; ++i) {
      scene.show(begin + (end - begin) * i / (frames - 1));
      scene.render();
      context.readPixels(0, 0, WIDTH, HEIGHT, context.RGBA, context.UNSIGNED_BYTE, pixels);
      for (let row = 0; row < HEIGHT; ++row) {
        const from = 4 * WIDTH * (HEIGHT - 1 - row);
        upright.set(pixels.subarray(from, from + 4 * WIDTH), 4 * WIDTH * row);
      }
      const palette = quantize(upright, 128);
      encoder.writeFrame(applyPalette(upright, palette), WIDTH, HEIGHT, { palette, delay: 1000 / RATE });
    }
  } finally {
    scene.resize();
  }
  encoder.finish();
  return encoder.bytes();
}

/** Record the canvas while the flight plays; returns a function that ends the recording. */
export function recordVideo(canvas, done) {
  const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm" });
  const pieces = [];
  recorder.ondataavailable = (event) => pieces.push(event.data);
  recorder.onstop = () => done(new Blob(pieces, { type: "video/webm" }));
  recorder.start();
  return () => recorder.stop();
}

export function download(content, name, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
