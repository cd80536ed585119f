// The worker's answers to questions about the mesh. They are loaded with the first question.

import type {Display} from '../picture/display';
import type {Inspector} from './inspector';
import type {Answer, Inspected} from './worker_messages';

export {Inspector} from './inspector';

export async function answerTo(
  question: Inspected,
  inspector: Inspector,
  display: Display,
): Promise<Answer> {
  switch (question.type) {
    case 'pick':
      return inspector.pick(question.ray, display);
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
    case 'numbers':
      return inspector.numbers(display);
  }
}
