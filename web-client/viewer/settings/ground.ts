// The ground behind the mesh, as the attribute says it: a name, or a colour.

/** By name: [over the canvas, one colour for pictures]; style.css has the gradients. */
const kBacks = {
  light: ['var(--light-back)', '#fff'],
  dark: ['var(--dark-back)', '#1a2029'],
  white: ['#fff', '#fff'],
} as const;
type GroundName = keyof typeof kBacks;

export const kGrounds = Object.keys(kBacks) as GroundName[];

/** The first is that of texts, the other that of softer ones. */
const kInks = {light: ['#16202c', '#556273'], dark: ['#e9eef5', '#9aa8ba']} as const;
/** The mean channel of a middle grey. */
export const kMiddle = 128;

/** A colour as RRGGBB. */
export const isHexColor = (text: string): boolean => /^[\da-f]{6}$/i.test(text);

const isName = (text: string): text is GroundName => kGrounds.includes(text as GroundName);

export const isGround = (text: string): boolean => isName(text) || isHexColor(text);

/** By name the properties of style.css that show it, with inks that are read on it. */
export function groundStyle(ground: string | null): Record<string, string | undefined> {
  const [back, plain] =
    ground === null ? [] : isName(ground) ? kBacks[ground] : [`#${ground}`, `#${ground}`];
  const [ink, soft] = ground === null ? [] : kInks[isDark(ground) ? 'dark' : 'light'];
  return {'own-back': back, 'own-ground': plain, 'scene-ink': ink, 'scene-ink-soft': soft};
}

function isDark(ground: string): boolean {
  if (isName(ground)) return ground === 'dark';
  const channels = [0, 2, 4].map((at) => parseInt(ground.slice(at, at + 2), 16));
  return channels.reduce((sum, channel) => sum + channel) / 3 < kMiddle;
}
