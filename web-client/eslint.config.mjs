// The rules of `npm run lint`, here and in ../tests: defects that the compiler does not see, and
// the house's own rules. Layout is prettier's.

import {fileURLToPath} from 'node:url';
import js from '@eslint/js';
import globals from 'globals';
import tseslint from 'typescript-eslint';

/** Rules for both languages. */
const shared = {
  eqeqeq: ['error', 'always', {null: 'ignore'}], // `== null` means null and undefined
  'max-len': ['error', {code: 100}],
  'max-params': ['error', 5],
  'no-useless-assignment': 'error',
};

export default tseslint.config(
  {ignores: ['**/node_modules/', '**/dist/']},
  {linterOptions: {reportUnusedDisableDirectives: 'error'}},
  {
    files: ['**/*.ts'],
    extends: [js.configs.recommended, ...tseslint.configs.strictTypeChecked],
    languageOptions: {
      parserOptions: {
        projectService: true,
        tsconfigRootDir: fileURLToPath(new URL('.', import.meta.url)),
      },
    },
    rules: {
      ...shared,
      'max-depth': ['error', 3],
      '@typescript-eslint/consistent-type-exports': 'error',
      '@typescript-eslint/consistent-type-imports': 'error',
      '@typescript-eslint/explicit-function-return-type': ['error', {allowExpressions: true}],
      '@typescript-eslint/no-import-type-side-effects': 'error',
      '@typescript-eslint/no-shadow': 'error',
      '@typescript-eslint/prefer-nullish-coalescing': 'error',
      '@typescript-eslint/prefer-optional-chain': 'error',
      '@typescript-eslint/prefer-readonly': 'error',
      '@typescript-eslint/require-array-sort-compare': 'error',
      '@typescript-eslint/switch-exhaustiveness-check': 'error',

      // `return this.fail(...)` ends a function early, in one line.
      '@typescript-eslint/no-confusing-void-expression': 'off',
      // The compiler asks for `!` at every index (noUncheckedIndexedAccess), and meshes are full of
      // indexes.
      '@typescript-eslint/no-non-null-assertion': 'off',
      // `find<HTMLSelectElement>(...)` says what the markup holds there, as querySelector does.
      '@typescript-eslint/no-unnecessary-type-parameters': 'off',
      // An async function turns what it throws into a rejection, with or without an await.
      '@typescript-eslint/require-await': 'off',
      // Messages contain numbers.
      '@typescript-eslint/restrict-template-expressions': ['error', {allowNumber: true}],
    },
  },
  {
    files: ['**/*.{js,mjs}'],
    extends: [js.configs.recommended],
    // Functions that a check passes to page.evaluate run in the browser.
    languageOptions: {globals: {...globals.node, ...globals.browser}},
    rules: shared,
  },
);
