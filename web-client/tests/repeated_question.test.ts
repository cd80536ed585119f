import {expect, test} from 'vitest';
import {RepeatedQuestion} from '../viewer/panels/repeated_question';

interface Asked {
  answer(text: string): Promise<void>;
  lose(): Promise<void>;
}

function makeQuestion(): {question: RepeatedQuestion<string>; asked: Asked[]; taken: string[]} {
  const asked: Asked[] = [];
  const taken: string[] = [];
  const settled = async (settle: () => void): Promise<void> => {
    settle();
    await new Promise((resolve) => setTimeout(resolve));
  };
  const ask = (): Promise<string> =>
    new Promise((resolve, reject) =>
      asked.push({
        answer: (text) => settled(() => resolve(text)),
        lose: () => settled(() => reject(new Error('lost'))),
      }),
    );
  return {question: new RepeatedQuestion(ask, (text) => taken.push(text)), asked, taken};
}

test('oneQuestionIsAskedAtATimeAndTheLastPicturesInTheEnd', async () => {
  const {question, asked, taken} = makeQuestion();
  for (let picture = 0; picture < 5; ++picture) question.repeat();
  expect(asked).toHaveLength(1);
  await asked[0]!.answer('first');
  expect(asked).toHaveLength(2);
  await asked[1]!.answer('last');
  expect(asked).toHaveLength(2);
  expect(taken).toEqual(['first', 'last']);
});

test('aLostAnswerEndsNothing', async () => {
  const {question, asked, taken} = makeQuestion();
  question.repeat();
  await asked[0]!.lose();
  question.repeat();
  await asked[1]!.answer('here');
  expect(taken).toEqual(['here']);
});

test('afterForgettingTheNextQuestionWaitsForNoneAndLateAnswersAreDropped', async () => {
  const {question, asked, taken} = makeQuestion();
  question.repeat();
  question.repeat();
  question.forget();
  question.repeat();
  expect(asked).toHaveLength(2);
  await asked[0]!.answer('of the mesh before');
  expect(asked).toHaveLength(2);
  await asked[1]!.answer('of this one');
  expect(taken).toEqual(['of this one']);
});

test('withoutAnythingToAskNothingWaits', () => {
  let count = 0;
  const question = new RepeatedQuestion(
    () => (++count, null),
    () => undefined,
  );
  question.repeat();
  question.repeat();
  expect(count).toBe(2);
});
