#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/topics.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

using Order = std::vector<std::size_t>;
constexpr bool late = true;

const MessageKind wind{"wind", {"east", "north"}};
const MessageKind heat{"heat", {"degrees"}};

/// What plugins of these names declare, one after the other.
struct Declared : Topics {
  void plugin(const std::string& name) {
    add_plugin(name, "a.urdf:" + std::to_string(++line_) + ": plugin '" + name + "'");
  }
  int line_ = 0;
};

}  // namespace

TEST_CASE("a message of any kind is a row of its fields and back") {
  const auto check = [](auto any, std::size_t width) {
    using Message = decltype(any);
    const MessageKind kind = messages::kind_of<Message>();
    CHECK(kind.fields.size() == width);
    std::vector<double> row(width), again(width, -1);
    for (std::size_t i = 0; i < width; ++i) row[i] = static_cast<double>(i) + 0.5;
    messages::write(messages::read<Message>(row.data()), again.data());
    CHECK(again == row);
  };
  check(messages::Odometry{}, 17);
  check(messages::Imu{}, 8);
  check(messages::Reference{}, 18);
  check(messages::Wrench{}, 6);
  check(messages::Vector{}, 3);
  CHECK(messages::kind_of<messages::Wrench>().fields ==
        std::vector<std::string>{"fx", "fy", "fz", "tx", "ty", "tz"});
  CHECK(messages::speeds(2) == MessageKind{"speeds", {"w1", "w2"}});
}

TEST_CASE("all that declare a topic mean the same one") {
  Declared topics;
  topics.plugin("one");
  MessageKind described = wind;
  described.meaning = "velocity of the air, m/s";
  const std::size_t first = topics.takes("wind", wind);
  topics.plugin("two");
  CHECK(topics.publishes("wind", described) == first);
  topics.settle();
  CHECK(topics[first].kind.meaning == described.meaning);
  CHECK(topics.find("wind") == static_cast<int>(first));
  CHECK(topics.find("rain") == -1);
  CHECK(refusal([&] { topics.at("wnd"); }) ==
        "topic 'wnd' does not exist. Did you mean 'wind'? Choose one of wind.");
  CHECK(topics[first].writer == 1);
  CHECK(topics[first].readers == std::vector<int>{0});
}

TEST_CASE("plugins that disagree about the kind of a topic are refused by name") {
  Declared topics;
  topics.plugin("one");
  topics.publishes("air", wind);
  topics.plugin("two");
  topics.takes("air", heat);
  CHECK(
      refusal([&] { topics.settle(); }) ==
      "a.urdf:2: plugin 'two' declares topic 'air' as 'heat' (degrees), but a.urdf:1: plugin 'one' "
      "declares it as 'wind' (east, north). Make the declarations agree.");
}

TEST_CASE("before the first message a topic holds what its takers go by") {
  const MessageKind left{"left", {"one", "other"}, {1, 0.5}};
  Declared topics;
  topics.plugin("writer");
  const std::size_t written = topics.publishes("written", {"left", {"one", "other"}});
  topics.plugin("listener");  // who says nothing goes by what others say
  const std::size_t open = topics.takes("open", {"left", {"one", "other"}});
  const std::size_t heard_late = topics.takes("written", left, late);
  topics.plugin("taker");
  topics.takes("open", left);
  topics.takes("written", left);
  const std::size_t silent = topics.takes("silent", wind);
  topics.settle();
  for (const std::size_t topic : {open, written, heard_late}) {
    CHECK(topics[topic].values == std::vector<double>{1, 0.5});
    CHECK(topics[topic].count == 0);
  }
  CHECK(topics[silent].values == std::vector<double>{0, 0});

  // Of a simulation with other tags only what was said is taken over.
  std::vector<Message> messages = topics.messages();
  for (Message& message : messages) message.values.assign(2, 7.0);
  messages[open].count = 1;
  topics.restore(messages);
  CHECK(topics[open].values == std::vector<double>{7, 7});
  CHECK(topics[written].values == std::vector<double>{1, 0.5});
}

TEST_CASE("takers that go by other numbers before the first message are refused by name") {
  for (const std::vector<double>& other : {std::vector<double>{0}, std::vector<double>{1, 1}}) {
    Declared topics;
    topics.plugin("one");
    topics.takes("riding", {"switch", {"riding"}, {1}});
    topics.plugin("two");
    topics.takes("riding", {"switch", {"riding"}, other});
    CHECK(refusal([&] { topics.settle(); }) ==
          "a.urdf:2: plugin 'two' and a.urdf:1: plugin 'one' assume different values of topic "
          "'riding' before the first message. Give both the same value for each field.");
  }
}

TEST_CASE("a topic has one writer") {
  Declared topics;
  topics.plugin("one");
  const std::size_t air = topics.publishes("air", wind);
  topics.plugin("two");
  topics.takes("air", wind);
  topics.settle();
  topics.write_as(0);
  topics.publish(air, 0);
  topics.publish(air, 1);
  topics.write_as(1);
  CHECK(refusal([&] { topics.publish(air, 2); }) ==
        "a.urdf:2: plugin 'two' writes topic 'air', which a.urdf:1: plugin 'one' already writes. "
        "Keep one of the two.");
  topics.write_as(the_caller);
  CHECK(contains(refusal([&] { topics.publish(air, 2); }), "the caller writes topic 'air'"));
  CHECK(topics[air].count == 2);
}

TEST_CASE("two plugins that declare themselves writers of a topic are refused by name") {
  Declared topics;
  topics.plugin("one");
  topics.publishes("air", wind);
  topics.plugin("two");
  topics.publishes("air", wind);
  CHECK(refusal([&] { topics.settle(); }) ==
        "a.urdf:2: plugin 'two' writes topic 'air', which a.urdf:1: plugin 'one' already writes. "
        "Keep one of the two.");
}

TEST_CASE("who takes a topic does not write it undeclared") {
  Declared topics;
  topics.plugin("one");
  const std::size_t air = topics.takes("air", wind);
  topics.settle();
  topics.write_as(0);
  CHECK(contains(refusal([&] { topics.publish(air, 0); }),
                 "a.urdf:1: plugin 'one' writes topic 'air', which it did not declare"));
}

TEST_CASE("names that a log or ROS could not carry are refused") {
  Declared topics;
  topics.plugin("one");
  for (const char* name : {"", "a b", "2nd", "/odom", "_x", "w\xc3\xa4rme"}) {
    CHECK(contains(refusal([&] { topics.publishes(name, heat); }), "is not a valid name. Start"));
    CHECK(contains(refusal([&] { topics.publishes("air", {"any", {name}}); }), "not a valid name"));
  }
}

TEST_CASE("a name may have parts, which are one word where names have none") {
  Declared topics;
  topics.plugin("one");
  const std::size_t truth = topics.publishes("ground_truth/imu/2", heat);
  CHECK(topics[truth].name == "ground_truth_imu_2");
  CHECK(topics[truth].path == "ground_truth/imu/2");
  CHECK(topics.at("ground_truth/imu/2") == truth);
  CHECK(topics.at("ground_truth_imu_2") == truth);
  CHECK(topics.takes("ground_truth_imu_2", heat) == truth);
  for (const char* name : {"/imu", "imu/", "ground//imu", "2/imu"}) {
    CHECK(contains(refusal([&] { topics.publishes(name, heat); }), "is not a valid name. Start"));
  }
}

TEST_CASE("writers run before readers, else plugins run by name, wherever they stand") {
  // c writes for b, which writes for d; a has nothing to do with them.
  const std::vector<std::string> wanted = {"a", "c", "b", "d"};
  std::vector<std::string> names = {"a", "b", "c", "d"};
  do {
    Declared topics;
    for (const std::string& name : names) {
      topics.plugin(name);
      if (name == "b") topics.takes("from_c", wind), topics.publishes("from_b", heat);
      if (name == "c") topics.publishes("from_c", wind);
      if (name == "d") topics.takes("from_b", heat);
    }
    std::vector<std::string> order;
    for (const std::size_t i : topics.settle()) order.push_back(names[i]);
    CHECK(order == wanted);
  } while (std::next_permutation(names.begin(), names.end()));
}

TEST_CASE("a loop is named, and one that reads a sample late breaks it") {
  const auto loop = [](bool read_late) {
    Declared topics;
    topics.plugin("outside");
    topics.takes("speed", heat);
    topics.plugin("controller");
    topics.takes("speed", heat, read_late);
    topics.publishes("wanted", wind);
    topics.plugin("motor");
    topics.takes("wanted", wind);
    topics.publishes("speed", heat);
    return topics.settle();
  };
  CHECK(loop(late) == Order{1, 2, 0});
  const std::string message = refusal([&] { loop(false); });
  CHECK(contains(message, "a.urdf:2: plugin 'controller' reads topic 'speed' from 'motor'"));
  CHECK(contains(message, "a.urdf:3: plugin 'motor' reads topic 'wanted' from 'controller'"));
  CHECK(contains(message, "each waits for the other's value of the same sample"));
  CHECK_FALSE(contains(message, "outside"));
}

TEST_CASE("a late reader has the value from before the sample, whoever runs first") {
  Declared topics;
  topics.plugin("a");
  const std::size_t in_time = topics.takes("heat", heat), before = topics.takes("heat", heat, late);
  topics.plugin("b");
  const std::size_t out = topics.publishes("heat", heat);
  topics.settle();
  CHECK(topics.names() == std::vector<std::string>{"heat"});
  topics.write_as(1);
  for (int sample = 1; sample < 4; ++sample) {
    topics.begin_sample();
    CHECK(topics[before].count == sample - 1);
    *topics.publish(out, sample) = 10 * sample;
    CHECK(topics[in_time].values[0] == 10 * sample);
    CHECK(topics[before].values[0] == 10 * (sample - 1));
    CHECK(topics[before].stamp == sample - 1);
  }
}

TEST_CASE("what is saved is restored, late values too") {
  Declared topics;
  topics.plugin("a");
  const std::size_t out = topics.publishes("heat", heat), air = topics.publishes("air", wind);
  topics.plugin("b");
  const std::size_t before = topics.takes("heat", heat, late);
  topics.settle();
  topics.write_as(0);
  *topics.publish(out, 1) = 5;
  topics.begin_sample();
  *topics.publish(out, 2) = 6;
  topics.publish(air, 2)[1] = 8;
  const std::vector<Message> saved = topics.messages();
  topics.begin_sample();
  topics.publish(air, 3)[1] = 9;
  topics.check(saved);
  topics.restore(saved);
  CHECK(topics[out].values[0] == 6);
  CHECK(topics[out].count == 2);
  CHECK(topics[before].values[0] == 5);
  CHECK(topics[before].stamp == 1);
  CHECK(topics[air].values == std::vector<double>{0, 8});
  CHECK(topics[air].count == 1);
  CHECK_THROWS_AS(topics.check({saved[0], saved[1]}), InputError);
  CHECK_THROWS_AS(topics.check({saved[1], saved[0], saved[2]}), InputError);
}
