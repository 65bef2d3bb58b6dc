#include "quadcore/plugin/topics.hpp"

#include <pybind11/stl.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "guarded.hpp"

namespace quadcore::bindings {
namespace {

/// Declaration of a topic by the plugins.
struct TopicInfo {
  std::string name, kind, meaning;
  std::vector<std::string> fields;
  std::optional<std::string> writer;  ///< empty for the caller
  std::vector<std::string> readers;
};

TopicInfo describe(const Simulation& simulation, const Topic& topic) {
  const auto name_of = [&](int plugin) {
    return simulation.plugins()[static_cast<std::size_t>(plugin)].name;
  };
  TopicInfo info{topic.name,        topic.kind.name, topic.kind.meaning,
                 topic.kind.fields, std::nullopt,    {}};
  if (topic.writer != the_caller) info.writer = name_of(topic.writer);
  for (const int reader : topic.readers) info.readers.push_back(name_of(reader));
  return info;
}

py::dict topics(const Self& self) {
  const Lock lock(*self);
  py::dict infos;
  for (const std::string& name : self->topics().names()) {
    infos[text(name)] = describe(*self.operator->(), self->topics()[self->topics().at(name)]);
  }
  return infos;
}

constexpr char topic_name[] = "topic";

py::dict topic(const Self& self, const Given<std::string, topic_name>& name) {
  const Lock lock(*self);
  const Topic& topic = self->topics()[self->topics().at(name.value)];
  py::dict message;
  message["stamp"] = topic.stamp;
  message["count"] = static_cast<std::int64_t>(topic.count);
  for (std::size_t i = 0; i < topic.values.size(); ++i) {
    message[text(topic.kind.fields[i])] = topic.values[i];
  }
  return message;
}

void publish(const Self& self, const Given<std::string, topic_name>& given,
             const ArrayLike& values) {
  const std::string& name = given.value;
  const Numbers array = numbers(values, 1, ("publish: topic '" + name + "'").c_str());
  if (name == Simulation::command_topic) refuse_in_flight(*self, "publish()");
  const Lock lock(*self);
  self->publish(name, array.data(), static_cast<std::size_t>(array.size()));
}

}  // namespace

void bind_topics(py::module_& m, py::class_<Guarded, std::shared_ptr<Guarded>>& simulation) {
  py::class_<TopicInfo>(m, "TopicInfo", "Declaration of a topic by the plugins.")
      .def("__repr__",
           [](const TopicInfo& t) {
             return py::str("<TopicInfo '{}', {}>").format(text(t.name), text(t.kind));
           })
      .def_readonly("name", &TopicInfo::name, "Name of the topic.")
      .def_property_readonly(
          "kind", [](const TopicInfo& t) { return text(t.kind); },
          "Kind of its messages, such as \"odometry\".")
      .def_property_readonly(
          "meaning", [](const TopicInfo& t) { return text(t.meaning); },
          "Meaning of the values, with their units.")
      .def_readonly("fields", &TopicInfo::fields,
                    "Names of the values of a message, in order, list of str.")
      .def_readonly("writer", &TopicInfo::writer,
                    "Plugin that publishes the topic; None if the caller may publish it.")
      .def_readonly("readers", &TopicInfo::readers, "Plugins that read the topic, list of str.");
  simulation.attr("command_topic") = Simulation::command_topic;
  simulation
      .def("topic", &topic, py::arg("name"), R"(Give the message that stands on a topic.

Parameters
----------
name : str
    One of `topics`.

Returns
-------
dict of str to float
    ``stamp`` (s), ``count`` (of the messages so far), and each field of the topic: before the first
    message what plugins go by until then, 0 where no number says it.

Raises
------
InputError
    There is no such topic.)")
      .def("publish", &publish, py::arg("topic"), py::arg("values"),
           "Publish a message on a topic that no plugin writes, with values in the order of its "
           "fields.")
      .def_property_readonly("topics", &topics, "Every topic by name, dict of str to TopicInfo.");
}

}  // namespace quadcore::bindings
