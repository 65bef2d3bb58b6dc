#include "quadcore/plugin/world.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "quadcore/plugin/error.hpp"
#include "quadcore/seen_or_sensed.hpp"
#include "quadcore/text.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;
using Handler = std::function<void(const Element&)>;
/// What to do with each child element; one that is not listed is refused by name.
using Handlers = std::map<std::string, Handler>;

/// What an element that holds others may have besides them.
std::set<std::string> attributes_of(const std::string& element) {
  if (element == "sdf") return {"version"};
  if (element == "atmosphere") return {"type"};
  if (element == "physics" || element == "physics:ode") return {"name", "default", "type"};
  if (element == "world" || element == "model" || element == "link" || element == "collision") {
    return {"name"};
  }
  return {};
}

/// Reads the elements that a world may hold into a World.
class WorldReader {
 public:
  WorldReader(const Document& document, const std::vector<std::string>& ignore)
      : xml_(document, "sdf", world_.passed_over) {
    world_.passed_over = PassedOver(ignore);
  }

  World read() {
    const Element& world = xml_.required_child(xml_.root(), "world");
    read_children(xml_.root(), {{"world", [](const Element&) {}}});
    refuse_both(xml_.child(world, "physics"), xml_.child(world, "physics:ode"));
    const Handler physics = [this, &world](const Element& e) {
      for (const char* const name : {"gravity", "magnetic_field"}) {
        refuse_both(xml_.child(world, name), xml_.child(e, name));
      }
      refuse_both(xml_.child(e, "real_time_update_rate"), xml_.child(e, "updateRate"));
      read_physics(e);
    };
    read_children(world,
                  {{"gravity", vector(world_.gravity_W)},
                   {"magnetic_field", vector(world_.magnetic_field_W)},
                   {"physics", physics},
                   {"physics:ode", physics},
                   {"spherical_coordinates", [this](const Element& e) { read_origin(e); }},
                   {"wind", [this](const Element& e) { read_wind(e); }},
                   {"atmosphere", [this](const Element& e) { read_atmosphere(e); }},
                   {"include", [this](const Element& e) { read_include(e); }},
                   {"model", [this](const Element& e) { read_model(e); }},
                   {"plugin", [this](const Element& e) { read_plugin(e); }}},
                  {"include", "model", "plugin"});
    return world_;
  }

 private:
  void read_children(const Element& element, const Handlers& handlers,
                     const std::set<std::string>& repeatable = {}) {
    xml_.only_attributes(element, attributes_of(element.Name()));
    std::set<std::string> names;
    for (const auto& entry : handlers) names.insert(entry.first);
    for (const Element* child : xml_.children(element, names, repeatable)) {
      handlers.at(child->Name())(*child);
    }
  }

  /// A number in [min, max] (max included); `open` excludes min.
  double in_range(const Element& e, double min, bool open, double max = INFINITY) {
    const double value = xml_.number_in_text(e);
    if (value < min || (open && value == min) || value > max) {
      std::ostringstream range;
      range << (open ? "> " : ">= ") << min;
      if (std::isfinite(max)) range << ", <= " << max;
      xml_.fail(e,
                "<" + std::string(e.Name()) + "> is out of range; write a number " + range.str());
    }
    return value;
  }

  Handler number(double& target, double min, bool open = false, double max = INFINITY) {
    return
        [this, &target, min, open, max](const Element& e) { target = in_range(e, min, open, max); };
  }

  Handler vector(Vector3d& target) {
    return [this, &target](const Element& e) { target = xml_.vector_in_text(e); };
  }

  Handlers physics_handlers() {
    return {{"max_step_size", number(world_.max_step_size, shortest_step)},
            {"real_time_update_rate", number(world_.real_time_update_rate, 0)},
            {"updateRate", number(world_.real_time_update_rate, 0)},
            {"real_time_factor", [this](const Element& e) { in_range(e, 0, true); }},
            {"gravity", vector(world_.gravity_W)},
            {"magnetic_field", vector(world_.magnetic_field_W)},
            {"ode", [this](const Element& e) { read_ode(e); }}};
  }

  /// Of two places for one value, giving both would leave open which counts.
  void refuse_both(const Element* first, const Element* second) {
    if (!first || !second) return;
    xml_.fail(*second, "<" + std::string(second->Name()) + "> beside <" + first->Name() + "> (" +
                           xml_.where(*first) + "); keep one of them");
  }

  void read_physics(const Element& physics) {
    const char* type = physics.Attribute("type");
    if (type && std::string(type) != "ode") {
      xml_.fail(physics, "physics type '" + std::string(type) + "' is not supported; write ode");
    }
    read_children(physics, physics_handlers());
  }

  void read_ode(const Element& ode) {
    read_children(ode, {{"solver", [this](const Element& e) { read_solver(e); }},
                        {"constraints", [this](const Element& e) {
                           read_children(e, {{"erp", number(world_.erp, 0, false, 1)},
                                             {"cfm", number(world_.cfm, 0)},
                                             {"contact_max_correcting_vel",
                                              number(world_.contact_max_correcting_vel, 0)}});
                         }}});
  }

  void read_solver(const Element& solver) {
    const auto type = [this](const Element& e) {
      world_.solver_type = xml_.text(e);
      world_.solver_type_where = xml_.where(e);
      if (world_.solver_type != "quick" && world_.solver_type != "world") {
        xml_.fail(e, "<type> is '" + world_.solver_type + "'; write quick or world");
      }
    };
    const auto iterations = [this](const Element& e) {
      const double value = xml_.number_in_text(e);
      if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
        xml_.fail(e, "<iters> must be a whole number from 1 to 1000000");
      }
      world_.solver_iterations = static_cast<int>(value);
    };
    const auto rescaling = [this](const Element& e) {
      if (xml_.text(e) == "0" || xml_.text(e) == "false") return;
      xml_.fail(e, "<use_dynamic_moi_rescaling> is '" + xml_.text(e) +
                       "'; the engines rescale no moments of inertia, write 0");
    };
    read_children(solver, {{"type", type},
                           {"iters", iterations},
                           {"sor", number(world_.solver_sor, 0, true, 2)},
                           {"use_dynamic_moi_rescaling", rescaling}});
  }

  void read_origin(const Element& origin) {
    const auto only = [this](const std::string& word) -> Handler {
      return [this, word](const Element& e) {
        if (xml_.text(e) == word) return;
        xml_.fail(e, "<" + std::string(e.Name()) + "> '" + xml_.text(e) +
                         "' is not supported; write " + word);
      };
    };
    Origin& at = world_.origin;
    read_children(origin, {{"surface_model", only("EARTH_WGS84")},
                           {"world_frame_orientation", only("ENU")},
                           {"latitude_deg", number(at.latitude, -90, false, 90)},
                           {"longitude_deg", number(at.longitude, -180, false, 180)},
                           {"elevation", number(at.altitude, -1e5, false, 1e7)},
                           {"heading_deg", number(at.heading, -360, false, 360)}});
  }

  void read_wind(const Element& wind) {
    read_children(wind, {{"linear_velocity", vector(world_.wind_W)}});
    xml_.required_child(wind, "linear_velocity");
  }

  void read_atmosphere(const Element& atmosphere) {
    const char* type = atmosphere.Attribute("type");
    if (type && std::string(type) != "adiabatic") {
      xml_.fail(atmosphere,
                "atmosphere type '" + std::string(type) + "' is not supported; write adiabatic");
    }
    Atmosphere& air = world_.atmosphere;
    const auto gradient = [this, &air](const Element& e) {
      air.temperature_gradient = xml_.number_in_text(e);
    };
    read_children(atmosphere, {{"temperature", number(air.temperature, 0, true)},
                               {"temperature_gradient", gradient},
                               {"pressure", number(air.pressure, 0)}});
  }

  void read_include(const Element& include) {
    const Element* source = xml_.child(include, "uri");
    const std::string uri = source ? xml_.text(*source) : "";
    if (source && uri != "model://ground_plane" && uri != "model://sun") {
      if (xml_.passed_over().ignores({uri})) return;
      xml_.fail(*source, "'" + uri +
                             "' is not supported; a world may include model://ground_plane and "
                             "model://sun" +
                             ignoring(uri));
    }
    read_children(include, {{"uri", [](const Element&) {}}});
    xml_.required_child(include, "uri");
    if (uri == "model://ground_plane") world_.ground_plane = true;  // the sun: no light here
  }

  void read_plugin(const Element& plugin) {
    const std::string name = xml_.attribute(plugin, "name");
    const std::string filename = xml_.attribute(plugin, "filename");
    if (xml_.passed_over().ignores({name, filename})) return;
    if (verdict_on_module(filename) == Verdict::unfelt) {
      return xml_.passed_over().add_unfelt(filename, xml_.where(plugin));
    }
    xml_.fail(plugin, "plugin '" + name + "': " + filename +
                          " is a module of Gazebo's worlds, which are not loaded here; remove it" +
                          ignoring(filename));
  }

  /// A model in line may only be a ground plane; another may be left out.
  void read_model(const Element& model) {
    const char* name = model.Attribute("name");
    if (!name) return read_ground_plane(model);
    if (xml_.passed_over().ignores({name})) return;
    try {
      read_ground_plane(model);
    } catch (const InputError& error) {
      throw InputError(error.what() + ignoring(name));
    }
  }

  /// Static, a plane through the origin, normal up.
  void read_ground_plane(const Element& model) {
    const Handler seen_only = [](const Element&) {};
    const Handler plane = [this](const Element& e) {
      read_children(e, {{"normal",
                         [this](const Element& n) {
                           if (!xml_.vector_in_text(n).isApprox(Vector3d::UnitZ())) {
                             xml_.fail(n, "only a level plane is supported; write 0 0 1");
                           }
                         }},
                        {"size", [](const Element&) {}}});
      world_.ground_plane = true;
    };
    const Handler collision = [this, plane](const Element& e) {
      read_children(e, {{"geometry", [this, plane](const Element& g) {
                           read_children(g, {{"plane", plane}});
                           xml_.required_child(g, "plane");
                         }}});
      xml_.required_child(e, "geometry");
    };
    read_children(model, {{"static",
                           [this](const Element& e) {
                             if (xml_.text(e) != "true" && xml_.text(e) != "1") {
                               xml_.fail(e, "only a static model is supported; write true");
                             }
                           }},
                          {"link", [this, collision, seen_only](const Element& e) {
                             read_children(e, {{"collision", collision}, {"visual", seen_only}},
                                           {"visual"});
                             xml_.required_child(e, "collision");
                           }}});
    xml_.required_child(model, "static");
    xml_.required_child(model, "link");
  }

  World world_;
  Xml xml_;
};

}  // namespace

World read_world(const Document& document, const std::vector<std::string>& ignore) {
  World world = WorldReader(document, ignore).read();
  world.source = std::make_shared<Source>(Source{document, ignore});
  return world;
}

}  // namespace quadcore
