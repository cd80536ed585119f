// The ground behind the mesh, as the attribute says it: a name, or a colour as RRGGBB.

/** style.css has a rule for each. */
export const kGrounds = ['light', 'dark', 'white'];

export const isHexColor = (text: string): boolean => /^[\da-f]{6}$/i.test(text);

export const isGround = (text: string): boolean => kGrounds.includes(text) || isHexColor(text);
