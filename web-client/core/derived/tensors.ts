// The quantities of symmetric tensors: fields of six components, xx, yy, zz, xy, yz, xz as VTK has
// them. Another quantity is a line in kTensorQuantities.

type Tuple = ArrayLike<number>;

export interface Quantity {
  /** Behind the field's name and a point, in addresses and expressions. */
  name: string;
  title: string;
  /** It can be below 0. */
  isSigned: boolean;
  isLinear?: true;
  /**
   * No value is larger than so many times the length of the six components. A change of them
   * changes it by no more times its length: each is a norm, or an eigenvalue (Weyl).
   */
  factor: number;
  of: (tensor: Tuple) => number;
}

/** The six components have each shear once, the tensor twice. */
const kLengths = Math.SQRT2;

/** In the order of the menu. */
export const kTensorQuantities: readonly Quantity[] = [
  {
    name: 'mises',
    title: 'von Mises',
    isSigned: false,
    factor: Math.sqrt(1.5) * kLengths,
    of: vonMises,
  },
  {
    name: 'tresca',
    title: 'Tresca',
    isSigned: false,
    factor: Math.SQRT2 * kLengths,
    of: (t) => principal(t, 0) - principal(t, 2),
  },
  ...[0, 1, 2].map((i) => ({
    name: `principal${i + 1}`,
    title: `${['1st', '2nd', '3rd'][i]} principal`,
    isSigned: true,
    factor: kLengths,
    of: (t: Tuple) => principal(t, i),
  })),
  {
    name: 'hydrostatic',
    title: 'hydrostatic',
    isSigned: true,
    isLinear: true,
    factor: Math.sqrt(1 / 3),
    of: mean,
  },
];

function mean(t: Tuple): number {
  return (t[0]! + t[1]! + t[2]!) / 3;
}

function vonMises(t: Tuple): number {
  return Math.sqrt(3 * secondInvariant(t));
}

/** J2: half the square of the deviator's length. */
function secondInvariant(t: Tuple): number {
  const [xx, yy, zz] = [t[0]!, t[1]!, t[2]!];
  const normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2;
  return normal / 6 + t[3]! ** 2 + t[4]! ** 2 + t[5]! ** 2;
}

/**
 * Eigenvalue `i`, the largest first, by the angle of the deviator's third invariant (Smith,
 * "Eigenvalues of a symmetric 3 x 3 matrix", 1961).
 */
function principal(t: Tuple, i: number): number {
  const middle = mean(t);
  const radius = Math.sqrt(secondInvariant(t) / 3);
  if (!(radius > 0)) return middle + radius; // all three are equal, or something is missing
  const [a, b, c] = [t[0]! - middle, t[1]! - middle, t[2]! - middle].map((x) => x / radius);
  const [d, e, f] = [t[3]! / radius, t[4]! / radius, t[5]! / radius];
  const half = (a! * (b! * c! - e * e) - d * (d * c! - e * f) + f * (d * e - b! * f)) / 2;
  const angle = Math.acos(Math.min(1, Math.max(-1, half))) / 3;
  // the angles of the largest, the middle and the smallest
  return middle + 2 * radius * Math.cos(angle + [0, -2, 2][i]! * (Math.PI / 3));
}
