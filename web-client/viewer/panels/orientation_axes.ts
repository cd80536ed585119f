// The axes in the corner, which turn with the camera.

const kNames = ['x', 'y', 'z'];
const kLength = 19;

export class OrientationAxes {
  private readonly axes: {line: SVGLineElement; text: SVGTextElement}[];

  constructor(private readonly svg: SVGSVGElement) {
    svg.replaceChildren(); // axes of a previous view
    this.axes = kNames.map((name) => {
      const line = document.createElementNS(svg.namespaceURI, 'line') as SVGLineElement;
      const text = document.createElementNS(svg.namespaceURI, 'text') as SVGTextElement;
      text.textContent = name;
      line.classList.add(`axis-${name}`);
      svg.append(line, text);
      return {line, text};
    });
  }

  /** `rotation` is the camera's quaternion. */
  turn(rotation: {x: number; y: number; z: number; w: number}): void {
    // The rows of the inverse rotation: the directions of the world's axes on the screen, and
    // towards the eye.
    const {x, y, z, w} = rotation;
    const right = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)];
    const up = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)];
    const near = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
    this.axes.forEach(({line, text}, i) => {
      line.setAttribute('x2', (kLength * right[i]!).toFixed(2));
      line.setAttribute('y2', (-kLength * up[i]!).toFixed(2));
      text.setAttribute('x', ((kLength + 6.5) * right[i]!).toFixed(2));
      text.setAttribute('y', (-(kLength + 6.5) * up[i]!).toFixed(2));
      line.style.opacity = text.style.opacity = near[i]! < -0.3 ? '0.45' : '1';
    });
    const backToFront = [0, 1, 2].sort((a, b) => near[a]! - near[b]!);
    this.svg.append(...backToFront.flatMap((i) => [this.axes[i]!.line, this.axes[i]!.text]));
  }
}
