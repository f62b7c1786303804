// camera: transform from the field to the canvas: zoom, pan, half-turns, and a quarter turn where the canvas is taller than wide.

export class Camera {
  constructor() {
    this.zoom = 1;
    this.pan = [0, 0];
    this.flipped = false;
    this.turned = false;
    this.size = [1, 1];
    this.scale = 1;
  }

  /** For a canvas of this size, in CSS pixels, and a field. */
  look(width, height, field) {
    const [length, breadth] = [field.length + 2 * field.margin, field.width + 2 * field.margin];
    this.turned = height > width * 1.1;
    const [along, across] = this.turned ? [height, width] : [width, height];
    this.size = [width, height];
    this.scale = Math.min(along / (length * 1.01), across / (breadth * 1.01)) * this.zoom;
  }

  matrix() {
    const sign = this.flipped ? -1 : 1;
    const s = this.scale * sign;
    const x = this.size[0] / 2 + this.pan[0];
    const y = this.size[1] / 2 + this.pan[1];
    // +y of the field is up on the screen; turned, +x is up.
    return this.turned ? [0, -s, -s, 0, x, y] : [s, 0, 0, -s, x, y];
  }

  /** Field to canvas. */
  to([fx, fy]) {
    const [a, b, c, d, e, f] = this.matrix();
    return [a * fx + c * fy + e, b * fx + d * fy + f];
  }

  /** Canvas to field. */
  from([px, py]) {
    const [a, b, c, d, e, f] = this.matrix();
    const det = a * d - b * c;
    return [(d * (px - e) - c * (py - f)) / det, (a * (py - f) - b * (px - e)) / det];
  }

  /** Zooms, and what lies at that pixel stays there. */
  zoomAt([px, py], factor) {
    const zoom = Math.min(12, Math.max(0.6, this.zoom * factor));
    const real = zoom / this.zoom;
    const centre = [this.size[0] / 2, this.size[1] / 2];
    this.pan = [px, py].map((at, i) => at - centre[i] - (at - centre[i] - this.pan[i]) * real);
    this.zoom = zoom;
    this.scale *= real;
  }

  reset() {
    this.zoom = 1;
    this.pan = [0, 0];
  }
}
