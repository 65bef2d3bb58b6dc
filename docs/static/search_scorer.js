// How the search of the site ranks results: pages for users first, then the reference of the code,
// then pages about the project. The other numbers are those of Sphinx.
var Scorer = {
  score: ([page, , , , score]) => {
    if (/^(changelog|contributing|security|testing)$/.test(page)) return score - 30;
    return page.startsWith("reference/") ? score - 20 : score;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
