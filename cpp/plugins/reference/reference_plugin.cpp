#include "control/tags.hpp"
#include "quadcore/control/reference.hpp"
#include "quadcore/control/rows_file.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/text.hpp"

namespace quadcore::reference {
namespace {

const std::vector<TagSpec>& shape_tags() {
  static const std::vector<TagSpec> tags = [] {
    std::vector<std::pair<std::string, std::vector<TagSpec>>> tables;
    for (const control::ReferenceInfo& info : control::references()) {
      tables.emplace_back(info.name, info.table);
    }
    return control::tags_of(tables);
  }();
  return tags;
}

/// Says where the vehicle is to be, at every step.
class ReferencePlugin final : public Plugin {
 public:
  explicit ReferencePlugin(const PluginSetup& setup)
      : shape_(control::make_reference(
            setup.parameters.choice("shape"), control::values_of(setup.parameters, shape_tags()),
            setup.parameters.has("rows") ? control::read_rows(setup.parameters.file("rows"))
                                         : control::Rows())),
        topic_(setup.topics.publishes(setup.parameters.text("topic"),
                                      messages::kind_of<messages::Reference>())) {}

  void update(const Sample& sample, PluginState) const override {
    sample.topics.publish(topic_, sample.time, shape_->at(sample.time));
  }

 private:
  std::unique_ptr<const control::ReferenceShape> shape_;
  std::size_t topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  std::vector<std::string> names, of_rows;
  for (const control::ReferenceInfo& info : control::references()) {
    names.push_back(info.name);
    if (info.takes_rows) of_rows.push_back(info.name);
  }
  std::vector<TagSpec> tags = {
      T::choice("shape", names, "where the vehicle is to be"),
      T::file("rows", "of " + joined(of_rows) + ": times and places, .csv or .yaml")
          .or_absent("none, for the other shapes"),
      T::text("topic", "reference", "where the messages are published"),
  };
  tags.insert(tags.end(), shape_tags().begin(), shape_tags().end());
  return {"a reference for a controller", tags, {}, create<ReferencePlugin>};
}

}  // namespace
}  // namespace quadcore::reference

QUADCORE_REGISTER_PLUGIN(quadcore::reference::describe)
