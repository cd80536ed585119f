// Which fields are predicted from which.

export class FieldParents {
  /** Results of order, which every step asks for. */
  private readonly orders = new WeakMap<readonly number[], number[]>();

  /** By field: those that it is predicted from. */
  constructor(readonly of: readonly (readonly number[])[]) {}

  /** These fields, each behind those that it is predicted from, each once. */
  order(fields: readonly number[]): readonly number[] {
    const known = this.orders.get(fields);
    if (known) return known;
    const out = new Set<number>();
    const add = (field: number): void => {
      if (out.has(field)) return;
      for (const parent of this.of[field] ?? []) add(parent);
      out.add(field);
    };
    for (const field of fields) add(field);
    const order = [...out];
    this.orders.set(fields, order);
    return order;
  }
}
