#include "controller_setup.hpp"
#include "quadcore/plugin.hpp"

namespace quadcore::reference {
namespace {

/// Publishes the reference in every step.
class ReferencePlugin final : public Plugin {
 public:
  explicit ReferencePlugin(const PluginSetup& setup)
      : shape_(control::reference_of(setup.parameters, setup.model)),
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
  std::vector<TagSpec> tags = control::reference_tags();
  tags.push_back(TagSpec::text("topic", "reference", "topic of the messages"));
  return {"publishes a reference for a controller", tags, {}, create<ReferencePlugin>};
}

}  // namespace
}  // namespace quadcore::reference

QUADCORE_REGISTER_PLUGIN(quadcore::reference::describe)
