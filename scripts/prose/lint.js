// Reads [{name, text}] as JSON, texts being Markdown, and writes [{name, line, message}].

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import terminology from "textlint-rule-terminology";
import sentences from "./sentences.js";

const require = createRequire(import.meta.url);
const { TextlintKernel } = require("@textlint/kernel");
const markdown = require("@textlint/textlint-plugin-markdown").default;

// The rule looks for whole words, unless a pattern says what may stand around it.
const words = JSON.parse(readFileSync(new URL("words.json", import.meta.url), "utf8"));
const terms = words.map(([word, better]) => [word.startsWith("(?<") ? word : `(?:${word})`, better]);
const options = {
  ext: ".md",
  plugins: [{ pluginId: "markdown", plugin: markdown }],
  rules: [
    { ruleId: "sentences", rule: sentences, options: { limit: 30 } },
    {
      ruleId: "terminology",
      rule: terminology,
      options: { terms, defaultTerms: false, skip: [] },
    },
  ],
};

const kernel = new TextlintKernel();
const found = [];
for (const { name, text } of JSON.parse(readFileSync(0, "utf8"))) {
  const { messages } = await kernel.lintText(text, options);
  for (const { line, message } of messages) found.push({ name, line, message });
}
process.stdout.write(JSON.stringify(found));
