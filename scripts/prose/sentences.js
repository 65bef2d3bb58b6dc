// A textlint rule: a sentence has few words, and does not begin with a headless clause.

const HEADLESS = /^\W*(What|Whatever|Who|Whoever|Of (each|the|a|an|every|all)) .*[^?]$/s;

/**
 * Blank the markup, keep each position: code and formulas become one word, links their text.
 * A word of code has capitals, so that a sentence may start with it.
 */
function readProse(node) {
  const start = node.range[0];
  const text = Array(node.range[1] - start).fill(" ");
  const fill = (part, of) => {
    for (let at = part.range[0]; at < part.range[1]; at++) text[at - start] = of(at - part.range[0]);
  };
  const read = (part) => {
    if (part.type === "Str") fill(part, (at) => part.raw[at]);
    else if (part.type === "Code") fill(part, () => "C");
    else (part.children ?? []).forEach(read);
  };
  read(node);
  return text
    .join("")
    .replace(/\n/g, " ")
    .replace(/\$[^$]+\$/g, (formula) => "X".repeat(formula.length));
}

export default function (context, { limit }) {
  const sentences = new Intl.Segmenter("en", { granularity: "sentence" });
  const check = (node) => {
    for (const { segment, index } of sentences.segment(readProse(node))) {
      const at = index + segment.search(/\S|$/);
      const say = (message) => context.report(node, new context.RuleError(message, { index: at }));
      const words = segment.match(/\S*[\p{L}\p{N}]\S*/gu)?.length ?? 0;
      if (words > limit) say(`A sentence has ${words} words. Split it; ${limit} is the limit.`);
      const sentence = segment.trim();
      if (HEADLESS.test(sentence)) {
        const start = sentence.split(/\s+/, 3).join(" ");
        say(`A sentence starts with "${start}". Say who does what.`);
      }
    }
  };
  return { Paragraph: check, TableCell: check, Header: check };
}
