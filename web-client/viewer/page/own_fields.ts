// The derived fields of a mesh, behind those of its manifest. The worker reads their definitions.

import type {DerivedField, MayDerive} from '../../core/picture/derived_field';
import {kMagnitude} from '../../core/picture/field_scale';
import {fieldOfKey} from '../../core/layers/field_values';
import type {Manifest} from '../../core/protocol/manifest';
import type {Client} from '../../core/session/client';
import type {Snapshot} from '../../core/session/worker_messages';

interface OwnMesh {
  readonly manifest: Manifest | null;
  readonly snapshot: Snapshot | null;
}

export class OwnFields {
  /** The definitions are being read. */
  isAwaited = false;
  /** Sentences about definitions that are wrong. */
  errors: readonly string[] = [];
  private fields: readonly DerivedField[] = [];
  /** The manifest's. */
  private first = 0;
  private manifest: Manifest | null = null;
  private text = '';

  /** Adds the fields to the mesh's manifest. `done` is called when they have changed. */
  read(text: string, mesh: OwnMesh, client: Client, done: () => void): void {
    const manifest = mesh.manifest!;
    const isSame = manifest === this.manifest;
    if (isSame && text === this.text) return;
    if (!isSame) this.first = manifest.fields.length;
    this.manifest = manifest;
    this.text = text;
    this.isAwaited = true;
    void client.derive(text).then(({fields, errors}) => {
      if (manifest !== this.manifest || text !== this.text) return;
      this.isAwaited = false;
      this.fields = fields;
      this.errors = errors;
      this.addTo(manifest);
      if (mesh.snapshot) this.fit(mesh.snapshot);
      done();
    });
  }

  /** In place of those that it had. */
  private addTo(manifest: Manifest): void {
    const {fields, first} = this;
    manifest.fields = [...manifest.fields.slice(0, first), ...fields.map(({info}) => info)];
    manifest.levels.forEach(({error}, level) => {
      const more = fields.map(({errors}) => errors[level] ?? {mean: NaN, max: NaN});
      if (error) error.fields = [...error.fields.slice(0, first), ...more];
    });
  }

  /** The manifest's fields that a field is made of, those of a series at the shown instant. */
  inputsOf(field: number): number[] {
    const inputs = this.fields[field - this.first]?.inputs;
    return inputs?.map((key) => fieldOfKey(key, this.manifest!.fields)) ?? [field];
  }

  /** The same, without those whose name has a time: playing shows another instant of each. */
  playedOf(field: number): number[] {
    const {fields} = this.manifest!;
    const inputs = this.fields[field - this.first]?.inputs;
    return inputs
      ? this.inputsOf(field).filter((its, i) => fields[its]?.instant?.series === inputs[i])
      : [field];
  }

  /** A picture's colour has the number of its field now, or none if that has gone. */
  fit(snapshot: Snapshot): void {
    const i = this.fields.findIndex(({id}) => id === snapshot.derivedId);
    if (snapshot.derivedId !== undefined)
      snapshot.color = i < 0 ? null : {field: this.first + i, component: kMagnitude};
  }

  /** For a display: quantities of tensors and vectors only if they are shown. */
  shown(used: readonly (number | undefined)[]): MayDerive {
    const {fields, first} = this;
    if (fields.length === 0) return {};
    const isWanted = (i: number): boolean => !fields[i]!.info.of || used.includes(first + i);
    const own = fields.map(({id, info}, i) => ({
      id,
      info,
      inputs: isWanted(i) ? this.inputsOf(first + i) : [],
    }));
    return {derived: {first, fields: own}};
  }
}
