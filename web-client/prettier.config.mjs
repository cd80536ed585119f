// The layout of TypeScript, JavaScript and CSS, here and in ../tests (npm run format).

export default {
  printWidth: 100,
  singleQuote: true,
  bracketSpacing: false,
};
