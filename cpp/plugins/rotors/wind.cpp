#include <cmath>
#include <filesystem>
#include <optional>

#include "center_of_mass.hpp"
#include "naming.hpp"
#include "quadcore/plugin.hpp"
#include "quadcore/plugin/error.hpp"
#include "wind_field.hpp"

namespace quadcore::rotors {
namespace {

/// A constant force and a gust on the frame, and a wind on the rotors' drag; or a wind field
/// without force and gust.
class Wind final : public Plugin {
 public:
  explicit Wind(const PluginSetup& setup)
      : p_FQ_F_(point(setup)),
        p_FS_F_(place_of(setup, "linkName").xyz),
        force_W_(along(setup, "windForceMean", "windDirection")),
        gust_W_(along(setup, "windGustForceMean", "windGustDirection")),
        begin_(setup.parameters.number("windGustStart")),
        end_(begin_ + setup.parameters.number("windGustDuration")),
        v_WA_W_(along(setup, "windSpeedMean", "windDirection")),
        force_topic_(setup.topics.publishes(topic_of(setup, "windForcePubTopic"),
                                            messages::kind_of<messages::Wrench>())),
        speed_topic_(setup.topics.publishes(topic_of(setup, "windSpeedPubTopic"),
                                            messages::kind_of<messages::WindSpeed>())) {
    if (!setup.parameters.flag("useCustomStaticWindField")) return;
    field_.emplace(path_of_field(setup.parameters));
    for (const char* tag : {"windForceMean", "windGustForceMean"}) {
      if (setup.parameters.number(tag) == 0) continue;
      setup.warnings.push_back(
          std::string("<") + tag +
          "> has no effect together with a wind field, as in RotorS. Remove it.");
    }
    force_W_ = gust_W_ = Vector3d::Zero();
  }

  std::size_t state_size() const override { return 1; }

  void update(const Sample& sample, PluginState gusty) const override {
    const double now = sample.time + sample.dt;  // RotorS' clock has already advanced
    gusty[0] = now >= begin_ - 1e-9 && now < end_ - 1e-9 ? 1 : 0;
    sample.topics.publish(speed_topic_, now, messages::WindSpeed{wind(sample.kinematics)});
    if (field_) return;
    sample.topics.publish(force_topic_, now, messages::Wrench{force(gusty[0]), Vector3d::Zero()});
  }

  void forces(const Kinematics& k, ConstPluginState gusty, Loads& loads) const override {
    loads.add_frame_force(0, k.R_WF.transpose() * force(gusty[0]), p_FQ_F_);
  }

  void air(const Kinematics& k, ConstPluginState, Vector3d& v_WA_W) const override {
    v_WA_W += wind(k);
  }

 private:
  /// Return the wind at the link's origin; outside the field, the wind of the tags.
  Vector3d wind(const Kinematics& k) const {
    Vector3d v_WA_W = v_WA_W_;
    if (field_) field_->at(k.p_WF + k.R_WF * p_FS_F_, v_WA_W);
    return v_WA_W;
  }
  Vector3d force(double gusty) const { return force_W_ + gusty * gust_W_; }

  /// Return the path relative to the document of the tag or, if set by the caller, to the working
  /// directory.
  static std::string path_of_field(const Parameters& parameters) {
    for (const Parameter& parameter : parameters.all()) {
      if (parameter.spec.name != "customWindFieldPath" || parameter.text.empty()) continue;
      const std::filesystem::path path = parameter.text;
      if (path.is_absolute() || parameter.origin == "set") return path.string();
      const std::filesystem::path document =
          parameter.origin.substr(0, parameter.origin.rfind(':'));
      return (document.parent_path() / path).lexically_normal().string();
    }
    throw InputError(
        "<useCustomStaticWindField> is true, but <customWindFieldPath> is missing. Add the path of "
        "the file.");
  }

  static Vector3d point(const PluginSetup& setup) {
    const Pose X_FS = place_of(setup, "linkName");
    const Vector3d offset_S(setup.parameters.numbers("xyzOffset").data());
    return X_FS.xyz +
           X_FS.rotation() *
               (center_of_mass(setup.model, setup.parameters.text("linkName")) + offset_S);
  }

  static Vector3d along(const PluginSetup& setup, const char* strength, const char* direction) {
    const Vector3d axis(setup.parameters.numbers(direction).data());
    const double length = axis.norm();
    if (!(length > 0)) {
      throw InputError(std::string("<") + direction +
                       "> is zero. Write a direction such as 1 0 0.");
    }
    return setup.parameters.number(strength) / length * axis;
  }

  Vector3d p_FQ_F_;            ///< point of application of the forces [m]
  Vector3d p_FS_F_;            ///< origin of the link [m]
  Vector3d force_W_, gust_W_;  ///< N
  double begin_, end_;         ///< s
  Vector3d v_WA_W_;            ///< m/s
  std::optional<WindField> field_;
  std::size_t force_topic_, speed_topic_;
};

PluginDescriptor describe() {
  using T = TagSpec;
  const char* const unused = "RotorS reads but does not use it either";
  std::vector<TagSpec> tags = {
      T::link("linkName", "link on which the forces act").must(),
      T::numbers("xyzOffset", "m", "0 0 0",
                 "point of application relative to the link's centre of mass, link axes")
          .of(3),
      T::numbers("windDirection", "", "1 0 0",
                 "direction of the force and of the wind, world axes, any length")
          .of(3),
      T::number("windForceMean", "N", "0", "constant force"),
      T::number("windSpeedMean", "m/s", "0", "wind speed that acts on the rotors' drag"),
      T::numbers("windGustDirection", "", "0 1 0", "direction of the gust, world axes, any length")
          .of(3),
      T::number("windGustForceMean", "N", "0", "force of the gust"),
      T::number("windGustStart", "s", "10", "start of the gust"),
      T::number("windGustDuration", "s", "0", "duration of the gust").at_least(0),
      T::text("windForcePubTopic", "external_force", "topic of the force including the gust, N"),
      T::text("windSpeedPubTopic", "wind_speed",
              "topic of the wind velocity, m/s; it acts on all aerodynamic effects"),
      T::text("frameId", "world", "frame_id of both messages in the ROS node"),
      T::flag("useCustomStaticWindField", "false",
              "whether to read a wind field from a file, which replaces force and gust; outside "
              "it, windSpeedMean applies"),
      T::text("customWindFieldPath", "",
              "file of the wind field, relative to the document that contains the tag")
          .or_absent("none"),
  };
  for (TagSpec& tag : tags) tag.equation = "RotorS";
  for (const char* name : {"windForceVariance", "windGustForceVariance", "windSpeedVariance"}) {
    tags.push_back(idle(name, unused));
  }
  tags.push_back(namespace_tag());
  return {"RotorS' wind: a constant force, a gust, and wind on the rotors",
          tags,
          {"wind_force"},
          create<Wind>};
}

}  // namespace
}  // namespace quadcore::rotors

QUADCORE_REGISTER_PLUGIN(quadcore::rotors::describe)
