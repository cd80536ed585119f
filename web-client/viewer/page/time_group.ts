// Viewers of one document that show the same time: those with one name in `time-group`.

/** A viewer, as its group sees it. */
export interface TimeMember {
  /** The time that it shows, as text; null: the one that opens, which is not known yet. */
  readonly time: string | null;
  /** Shows the instant nearest to this time; null: the one that opens. */
  take(time: string | null): void;
  /** Stops playing. */
  stop(): void;
}

/** The place of a viewer in its group. */
export interface Membership {
  /** Must be called when the viewer was moved, or begins to play: the others follow. */
  lead(): void;
  leave(): void;
}

class TimeGroup {
  readonly members = new Set<TimeMember>();
  private leader: TimeMember | null = null;
  private time: string | null = null;
  /** Those who follow change their time as well, and do not lead by that. */
  private isPassing = false;

  join(member: TimeMember): void {
    const [first] = this.members;
    this.members.add(member);
    if (!first) return;
    const time = this.time ?? first.time;
    if (time === null && member.time !== null) this.lead(member);
    else this.pass(() => member.take(time));
  }

  lead(member: TimeMember): void {
    const {time} = member;
    if (this.isPassing || (this.leader === member && this.time === time)) return;
    this.leader = member;
    this.time = time;
    this.pass(() => {
      for (const other of this.members) {
        if (other === member) continue;
        other.stop();
        other.take(time);
      }
    });
  }

  private pass(action: () => void): void {
    this.isPassing = true;
    try {
      action();
    } finally {
      this.isPassing = false;
    }
  }
}

const groupsIn = new WeakMap<object, Map<string, TimeGroup>>();

/**
 * The member takes the time of the document's group of this name. Where that is not known yet, the
 * group takes the member's.
 */
export function joinTimeGroup(document: object, name: string, member: TimeMember): Membership {
  const groups = groupsIn.get(document) ?? new Map<string, TimeGroup>();
  groupsIn.set(document, groups);
  const group = groups.get(name) ?? new TimeGroup();
  groups.set(name, group);
  group.join(member);
  return {
    lead: () => group.lead(member),
    leave: () => {
      group.members.delete(member);
      if (group.members.size === 0) groups.delete(name);
    },
  };
}
