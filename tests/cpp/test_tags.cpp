#include "quadcore/plugin/tags.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

using Overrides = std::map<std::string, std::string>;

const std::vector<TagSpec> specs = {
    TagSpec::number("gain", "N", "", "a gain").must().at_least(0),
    TagSpec::number("rate", "1/s", "50", "a rate").above(0).at_most(100).also_called("updateRate"),
    TagSpec::number("limit", "m", "", "a limit").or_absent("none"),
    TagSpec::flag("loud", "false", "a flag"),
    TagSpec::choice("model", {"plain", "fancy"}, "a choice"),
    TagSpec::link("link", "a link"),
    TagSpec::joints("rotors", "rotors"),
    TagSpec::text("label", "none given", "a text"),
    TagSpec::numbers("gains", "N", "1 2 3", "three gains").of(3).at_least(0),
    TagSpec::numbers("row", "", "", "numbers").or_absent("empty"),
    TagSpec::file("table", "a file"),
};

const Model& vehicle() {
  static const Model instance = model(
      link("frame", 1, round_body) + link("tip", 0.1, round_body) + link("a", 0.01, round_rotor) +
      link("b", 0.01, round_rotor) + joint("weld", "fixed", "frame", "tip") +
      joint("j1", "continuous", "frame", "a") + joint("j2", "continuous", "tip", "b"));
  return instance;
}

Parameters read(const std::vector<PluginTag>& tags, const Overrides& overrides = {}) {
  return Parameters(specs, {"p", "libp.so", tags, "test.urdf:9"}, vehicle(), overrides);
}

std::string refused(const std::vector<PluginTag>& tags, const Overrides& overrides = {}) {
  return refusal([&] { read(tags, overrides); });
}

const PluginTag gain = {"gain", " 2.5\n", "test.urdf:10"};

}  // namespace

TEST_CASE("what is not written has its default") {
  const Parameters p = read({gain});
  CHECK(p.number("gain") == 2.5);
  CHECK(p.number("rate") == 50);
  CHECK_FALSE(p.has("limit"));
  CHECK_FALSE(p.flag("loud"));
  CHECK(p.choice("model") == "plain");
  CHECK(p.choice("link") == "frame");
  CHECK(p.joints("rotors") == std::vector<std::size_t>{0, 1});
  CHECK(p.text("label") == "none given");
  CHECK(p.numbers("gains") == std::vector<double>{1, 2, 3});
  CHECK_FALSE(p.has("row"));
  CHECK(p.numbers("row").empty());
  CHECK_FALSE(p.has("table"));
  CHECK(p.file("table").empty());
  CHECK(p.all()[0].origin == "test.urdf:10");
  CHECK(p.all()[1].origin == "default");
}

TEST_CASE("what is written counts, and what is set outside counts more") {
  const std::vector<PluginTag> tags = {gain,
                                       {"updateRate", "20", "test.urdf:11"},
                                       {"limit", "7", "test.urdf:12"},
                                       {"loud", "true", "test.urdf:13"},
                                       {"model", "fancy", "test.urdf:14"},
                                       {"link", "tip", "test.urdf:15"},
                                       {"rotors", " j2\n j1 ", "test.urdf:16"}};
  const Parameters p = read(tags);
  CHECK(p.number("rate") == 20);
  CHECK(p.number("limit") == 7);
  CHECK(p.flag("loud"));
  CHECK(p.choice("model") == "fancy");
  CHECK(p.choice("link") == "tip");
  CHECK(p.joints("rotors") == std::vector<std::size_t>{1, 0});

  const Parameters q = read(tags, {{"rate", "30"}, {"rotors", "j1"}});
  CHECK(q.number("rate") == 30);
  CHECK(q.joints("rotors") == std::vector<std::size_t>{0});
  CHECK(q.all()[1].origin == "set");
}

TEST_CASE("the ends of a range belong to it unless they are excluded") {
  const auto rate = [](const char* text) -> PluginTag { return {"rate", text, "test.urdf:11"}; };
  CHECK(read({{"gain", "0", "test.urdf:10"}}).number("gain") == 0);
  CHECK(read({gain, rate("100")}).number("rate") == 100);
  CHECK(contains(refused({gain, rate("0")}), "<rate> '0' is out of range. Use a number > 0"));
  CHECK(contains(refused({gain, rate("100.001")}), "> 0, <= 100"));
}

TEST_CASE("a range reads as a person would write it") {
  const char* ranges[] = {">= 0",
                          "> 0, <= 100",
                          "any finite number",
                          "true | false",
                          "plain | fancy",
                          "a link of the model",
                          "names of continuous joints",
                          "any text",
                          "3 numbers, each >= 0",
                          "finite numbers",
                          "a file, relative to the model"};
  for (std::size_t i = 0; i < specs.size(); ++i) CHECK(specs[i].range() == ranges[i]);
}

TEST_CASE("a refusal names place, plugin and tag") {
  CHECK(refused({}).rfind("test.urdf:9: plugin 'p': required tag <gain> is missing", 0) == 0);
  CHECK(refused({gain, {"gian", "1", "test.urdf:11"}})
            .rfind("test.urdf:11: plugin 'p': unknown tag <gian>. Did you mean 'gain'?", 0) == 0);
  CHECK(refused({gain, {"gain", "1", "test.urdf:11"}}).rfind("test.urdf:11: plugin 'p': ", 0) == 0);
  CHECK(contains(refused({gain, {"rate", "1", "a:1"}, {"updateRate", "1", "a:2"}}), "is repeated"));
  CHECK(refused({gain}, {{"rate", "fast"}}).rfind("set p.rate: plugin 'p': <rate> 'fast'", 0) == 0);
  CHECK(refused({gain}, {{"rte", "1"}}).rfind("set p.rte: plugin 'p': unknown tag <rte>", 0) == 0);
}

TEST_CASE("a tag is set by one of its names, and a refusal names both") {
  CHECK(refused({gain}, {{"rate", "1"}, {"updateRate", "1"}}) ==
        "set p.updateRate: plugin 'p': is the same tag as <rate>, which is also set. Keep one of "
        "them.");
  CHECK(read({gain, {"rate", "1", "a:1"}}, {{"updateRate", "2"}}).number("rate") == 2);
}

TEST_CASE("an override does not excuse a tag that is wrong in the file") {
  CHECK_THROWS_AS(read({gain, gain}, {{"gain", "1"}}), InputError);
}

TEST_CASE("a row of numbers has the length, the numbers and the range of its table") {
  const auto row = [](const char* name, const char* text) -> PluginTag {
    return {name, text, "test.urdf:11"};
  };
  CHECK(read({gain, row("gains", " 0\n 1e-3\t 7 ")}).numbers("gains") ==
        std::vector<double>{0, 1e-3, 7});
  CHECK(read({gain, row("row", "-1")}).numbers("row") == std::vector<double>{-1});
  CHECK(read({gain}, {{"row", "4 -5"}}).numbers("row") == std::vector<double>{4, -5});
  CHECK(refused({gain, row("gains", "1 2")}) ==
        "test.urdf:11: plugin 'p': <gains> '1 2' has 2 numbers. Write 3 numbers, each >= 0, in N, "
        "separated by blanks.");
  CHECK(contains(refused({gain, row("gains", "1 -2 3")}),
                 "contains -2, which is out of range. Write 3"));
  CHECK(
      contains(refused({gain, row("gains", "1 2,5 3")}), "contains '2,5', which is not a finite"));
  CHECK(
      contains(refused({gain, row("row", "nan")}), "contains 'nan', which is not a finite number"));
  CHECK(
      contains(refused({gain, row("row", "")}), "has 0 numbers. Write finite numbers, separated"));
  CHECK(refused({gain}, {{"gains", "1"}}).rfind("set p.gains: plugin 'p': <gains> '1'", 0) == 0);
}

TEST_CASE("a text is anything but nothing") {
  CHECK(read({gain, {"label", " two words\n", "test.urdf:11"}}).text("label") == "two words");
  CHECK(contains(refused({gain, {"label", " ", "test.urdf:11"}}), "<label> '' is empty. Write"));
}

TEST_CASE("a file counts from its document, one that is set from where the program runs") {
  const std::string at = TEST_DATA "/thesis/there.urdf:7";  // needs no document for a path from /
  const std::string folder = TEST_DATA "/gazebo11/cases/A1_ki/";
  const std::string table = folder + "commands.csv", document = folder + "model.urdf:7";
  const auto given = [](const std::string& path, const std::string& where) -> PluginTag {
    return {"table", path, where};
  };
  CHECK(read({gain, given("commands.csv", document)}).file("table") == table);
  CHECK(read({gain, given("../A1_ki/commands.csv", document)}).file("table") == table);
  CHECK(read({gain, given(table, at)}).file("table") == table);
  CHECK(read({gain}, {{"table", table}}).file("table") == table);
  CHECK(refused({gain, given("command.csv", document)}) ==
        document + ": plugin 'p': <table> 'command.csv' cannot be read: " + folder +
            "command.csv. Give the path of an existing file, relative to the document that "
            "contains the tag.");
  CHECK(contains(refused({gain, given("..", document)}), "<table> '..' is a folder. Name a file"));
  CHECK(contains(
      refused({gain, given("commands.csv", "robot_description:7")}),
      "is a relative path, but the model was not read from a file. Write an absolute path."));
  CHECK(contains(refused({gain}, {{"table", "commands.csv"}}), "set p.table: plugin 'p': <table>"));
}
