#include "quadcore/tags.hpp"
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
  CHECK(contains(refused({gain, rate("0")}), "<rate> '0' is out of range; write a number > 0"));
  CHECK(contains(refused({gain, rate("100.001")}), "> 0, <= 100"));
}

TEST_CASE("a range reads as a person would write it") {
  const char* ranges[] = {
      ">= 0",          "> 0, <= 100",         "any finite number",         "true | false",
      "plain | fancy", "a link of the model", "names of continuous joints"};
  for (std::size_t i = 0; i < specs.size(); ++i) CHECK(specs[i].range() == ranges[i]);
}

TEST_CASE("a refusal names place, plugin and tag") {
  CHECK(refused({}).rfind("test.urdf:9: plugin 'p': required tag <gain> is missing", 0) == 0);
  CHECK(refused({gain, {"gian", "1", "test.urdf:11"}})
            .rfind("test.urdf:11: plugin 'p': unknown tag <gian> (did you mean 'gain'?)", 0) == 0);
  CHECK(refused({gain, {"gain", "1", "test.urdf:11"}}).rfind("test.urdf:11: plugin 'p': ", 0) == 0);
  CHECK(contains(refused({gain, {"rate", "1", "a:1"}, {"updateRate", "1", "a:2"}}), "second time"));
  CHECK(refused({gain}, {{"rate", "fast"}}).rfind("set p.rate: plugin 'p': <rate> 'fast'", 0) == 0);
  CHECK(refused({gain}, {{"rte", "1"}}).rfind("set p.rte: plugin 'p': unknown tag <rte>", 0) == 0);
}

TEST_CASE("an override does not excuse a tag that is wrong in the file") {
  CHECK_THROWS_AS(read({gain, gain}, {{"gain", "1"}}), InputError);
}
