// How TypeScript, JavaScript and CSS are laid out, here and in ../tests (npm run format).

export default {
  printWidth: 100,
  singleQuote: true,
  bracketSpacing: false,
};
