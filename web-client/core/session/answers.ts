// The worker's answers to questions about the mesh. They are loaded with the first question.

import type {Display} from '../picture/display';
import type {Assembler} from '../decode/assembler';
import {Inspector} from './inspector';
import type {Answer, Inspected} from './worker_messages';

/** An inspector remembers the cells that it found. */
const inspectors = new WeakMap<Assembler, Inspector>();

export async function answerTo(
  question: Inspected,
  assembler: Assembler,
  display: Display,
): Promise<Answer> {
  const inspector = inspectors.get(assembler) ?? new Inspector(assembler);
  inspectors.set(assembler, inspector);
  switch (question.type) {
    case 'pick':
      return inspector.pick(question.ray, display);
    case 'trace':
      return inspector.trace(question, display);
    case 'probe':
      return inspector.probe(question.from, question.to, display);
    case 'line':
      return inspector.line(question.from, question.to, display);
    case 'at':
      return inspector.at(question.place, display);
    case 'values':
      return inspector.values(question.place, question.fields);
    case 'histogram':
      return inspector.histogram(question.axis, display);
    case 'parts':
      return inspector.parts(question.field);
    case 'kept':
      return inspector.kept(question.places, display);
    case 'numbers':
      return inspector.numbers(display);
  }
}
