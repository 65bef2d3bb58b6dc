#include "sdf_models.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "included_models.hpp"
#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "sdf_frames.hpp"
#include "sdf_free_bodies.hpp"
#include "sdf_shape.hpp"
#include "sdf_state.hpp"
#include "sdf_values.hpp"
#include "sdf_version.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;

/// Elements of a model that are read, or have an effect only on what moves.
const std::set<std::string> known_elements = {"static",      "self_collide", "allow_auto_disable",
                                              "enable_wind", "joint",        "frame",
                                              "gripper",     "pose"};
/// The same of a link.
const std::set<std::string> known_link_elements = {
    "pose",        "visual", "inertial",       "gravity", "kinematic",        "self_collide",
    "enable_wind", "light",  "velocity_decay", "damping", "must_be_base_link"};

std::string name_of(const Element& e) {
  const char* name = e.Attribute("name");
  return name ? trimmed(name) : "";
}

/// A model to read: an element of the world, or a file that it includes.
struct Given {
  const Xml* xml;                    ///< document of `model`
  const Element* model;              ///< `<model>`
  const Element* include = nullptr;  ///< the `<include>` that overrides it, in the world's document
};

class ModelReader {
 public:
  ModelReader(const Xml& xml, const Element& world)
      : xml_(xml),
        world_(world),
        saved_(read_saved_state(xml, world)),
        world_frames_(xml, world, !is_at_most_sdf(xml, world, 6)) {
    collect_files(xml.root());
  }

  WorldModels read() {
    found_.start_time = saved_.time;
    read_items(world_);
    for (const Element* inserted : saved_.inserted) read_items(*inserted);
    return std::move(found_);
  }

 private:
  /// Collect the models that are embedded in an `<include>`; others of the same URI share them.
  void collect_files(const Element& parent) {
    for (const Element* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const Element* sdf = e->FirstChildElement("sdf");
      const Element* uri = e->FirstChildElement("uri");
      if (e->Name() == std::string("include") && sdf && uri) files_.emplace(xml_.text(*uri), sdf);
      collect_files(*e);
    }
  }

  void read_items(const Element& parent) {
    for (const Element* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      if (kind == "model") read_item({&xml_, e});
      if (kind == "include") read_include(*e, [this](const Given& g) { read_item(g); });
    }
  }

  /// Find what an `<include>` names, unless it is no model or the user ignores it.
  template <class Read>
  void read_include(const Element& include, const Read& read) {
    const Element* given_uri = xml_.child(include, "uri");
    if (!given_uri) {
      return xml_.ignored_elements().add_unsimulated("an <include> without <uri>",
                                                     xml_.where(include));
    }
    const std::string uri = xml_.text(*given_uri);
    const Element* own = xml_.child(include, "name");
    const std::string name = own ? xml_.text(*own) : uri;
    if (xml_.ignored_elements().ignores({uri, name})) {
      found_.ignored.push_back(name);
      return;
    }
    const Element* sdf = xml_.child(include, "sdf");
    const Xml* xml = &xml_;
    const auto file = files_.find(uri);
    if (!sdf && file != files_.end()) sdf = file->second;
    if (sdf) {
      // A model in the same document.
    } else if (const std::string text = find_builtin_model(uri); !text.empty()) {
      xml = &open_builtin(uri, text);
      sdf = &xml->root();
    } else {
      return xml_.ignored_elements().add_unsimulated("the missing model " + uri,
                                                     xml_.where(*given_uri));
    }
    const Element* model = xml->child(*sdf, "model");
    if (model) {
      if (std::find(open_.begin(), open_.end(), sdf) != open_.end()) {
        xml_.fail(include,
                  "'" + uri + "' includes itself. Remove the <include>." + suggest_ignoring(uri));
      }
      open_.push_back(sdf);
      read({xml, model, &include});
      open_.pop_back();
      return;
    }
    if (xml->child(*sdf, "light") || xml->child(*sdf, "actor")) return;
    xml_.fail(include,
              "'" + uri + "' contains no <model>. Correct its file." + suggest_ignoring(uri));
  }

  const Xml& open_builtin(const std::string& uri, const std::string& text) {
    documents_.push_back(std::make_unique<Document>(Document{uri, text}));
    builtins_.push_back(std::make_unique<Xml>(*documents_.back(), "sdf", xml_.ignored_elements()));
    return *builtins_.back();
  }

  /// The element that counts: that of the include, which replaces that of the model's file.
  static const Element* overriding(const Given& given, const char* name) {
    const Element* own = given.include ? given.include->FirstChildElement(name) : nullptr;
    return own ? own : given.model->FirstChildElement(name);
  }

  /// Read a model or an include of the world.
  void read_item(const Given& given) {
    const Element* own = given.include ? given.include->FirstChildElement("name") : nullptr;
    const std::string name = own ? xml_.text(*own) : name_of(*given.model);
    const Element& place = given.include ? *given.include : *given.model;
    if (!name.empty() && !names_.insert(name).second) {
      return xml_.ignored_elements().add_harmless("a second model '" + name + "'",
                                                  xml_.where(place));
    }
    if (!name.empty() && xml_.ignored_elements().ignores({name})) {
      found_.ignored.push_back(name);
      return;
    }
    if (saved_.deleted.count(name)) return;
    const auto saved = saved_.models.find(name);
    try {
      const bool overrides = given.include && given.include->FirstChildElement("pose");
      const Placement pose =
          overrides || !given.include ? world_frames_.find_pose(place) : read_own_pose(given);
      const std::size_t bodies = found_.free_bodies.size(), joints = found_.free_joints.size();
      read_model(given, name, pose, pose, false,
                 saved == saved_.models.end() ? SavedModel() : saved->second);
      drop_without_shapes(bodies, joints);
    } catch (const InputError& error) {
      const std::string what = error.what();
      if (name.empty() || what.find("--ignore") != std::string::npos) throw;
      throw InputError(what + suggest_ignoring(name));
    }
  }

  /// Drop the free bodies from an index on if nothing can touch them.
  void drop_without_shapes(std::size_t bodies, std::size_t joints) {
    const auto first = found_.free_bodies.begin() + static_cast<std::ptrdiff_t>(bodies);
    if (std::any_of(first, found_.free_bodies.end(),
                    [](const FreeBody& body) { return !body.shapes.empty(); })) {
      return;
    }
    found_.free_bodies.resize(bodies);
    found_.free_joints.resize(joints);
  }

  static Placement read_own_pose(const Given& given) {
    const Element* pose = given.model->FirstChildElement("pose");
    return pose ? read_placement(*given.xml, *pose) : Placement();
  }

  /// Read a model and what is nested in it.
  /// \param written  pose in the world as the model has it
  /// \param X_WM  pose in the world without a saved state of this model
  /// Returns the links that move.
  std::vector<JointedLink> read_model(const Given& given, const std::string& name,
                                      const Placement& written, Placement X_WM,
                                      bool is_parent_static, const SavedModel& saved) {
    const Xml& xml = *given.xml;
    const Element& model = *given.model;
    if (++count_ > most_models) {
      xml.fail(model, "the world has more than 100000 models. Use a smaller world.");
    }
    const Element* fixed = overriding(given, "static");
    const bool is_static = fixed ? is_true(xml, fixed) : is_parent_static;
    const SdfFrames frames(xml, model, !is_at_most_sdf(xml, model, 6));
    if (saved.pose_W) X_WM = *saved.pose_W;
    std::vector<JointedLink> free_links;
    bool is_first = true;
    for (const Element* link = xml.child(model, "link"); link;
         link = link->NextSiblingElement("link")) {
      const Placement X_ML = frames.find_pose(*link);
      Placement X_WL = X_WM * X_ML;
      const auto state = saved.links.find(name_of(*link));
      const SavedLink moved = state == saved.links.end() ? SavedLink() : state->second;
      if (moved.pose_W) {
        X_WL = *moved.pose_W;
        if (is_first) X_WM = X_WL * X_ML.inverse();
      }
      is_first = false;
      std::vector<Obstacle> shapes =
          read_link(xml, *link, name, is_static, frames, written * X_ML, X_WL, saved.scale);
      if (is_static) {
        found_.obstacles.insert(found_.obstacles.end(), shapes.begin(), shapes.end());
        continue;
      }
      FreeBody body = read_free_body(xml, *link);
      body.model = name;
      body.position_W = X_WL.position;
      body.orientation_W = X_WL.rotation;
      body.linear_velocity_W = moved.linear_velocity_W;
      body.angular_velocity_W = moved.angular_velocity_W;
      const Element* own = xml.child(*link, "self_collide");
      body.collides_own = is_true(xml, own ? own : xml.child(model, "self_collide"));
      body.may_sleep &= !xml.child(model, "joint");
      body.shapes = std::move(shapes);
      free_links.push_back({body.name, found_.free_bodies.size(), X_ML});
      found_.free_bodies.push_back(std::move(body));
    }
    for (const Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      const auto nest = [&](const Given& nested, const std::string& inner, const Placement& pose) {
        const auto state = saved.models.find(inner);
        for (JointedLink link :
             read_model(nested, name + "::" + inner, written * pose, X_WM * pose, is_static,
                        state == saved.models.end() ? SavedModel() : state->second)) {
          link.name = inner + "::" + link.name;
          link.X_ML = pose * link.X_ML;
          free_links.push_back(link);
        }
      };
      if (kind == "model") {
        nest({&xml, e}, name_of(*e), frames.find_pose(*e));
      } else if (kind == "include") {
        read_include(*e, [&](const Given& nested) {
          const Element* own = e->FirstChildElement("name");
          nest(nested, own ? xml.text(*own) : name_of(*nested.model),
               e->FirstChildElement("pose") ? frames.find_pose(*e) : read_own_pose(nested));
        });
      } else if (kind == "plugin") {
        skip_plugin(xml, *e, name);
      } else if (kind != "link" && !known_elements.count(kind)) {
        xml.ignored_elements().add_harmless("<" + kind + "> in <model>", xml.where(*e));
      }
    }
    if (!is_static && !free_links.empty()) read_joints(xml, model, name, free_links, frames, X_WM);
    if (!given.include) return free_links;
    for (const Element* e = given.include->FirstChildElement("plugin"); e;
         e = e->NextSiblingElement("plugin")) {
      skip_plugin(xml_, *e, name);
    }
    return free_links;
  }

  void read_joints(const Xml& xml, const Element& model, const std::string& name,
                   const std::vector<JointedLink>& links, const SdfFrames& frames,
                   const Placement& X_WM) {
    for (const Element* e = xml.child(model, "joint"); e; e = e->NextSiblingElement("joint")) {
      FreeJoint joint = read_free_joint(xml, *e, links, frames, X_WM);
      joint.name = name + "::" + joint.name;
      found_.free_joints.push_back(std::move(joint));
    }
  }

  /// Return the shapes of a link that move with it, or all if it stands still.
  std::vector<Obstacle> read_link(const Xml& xml, const Element& link, const std::string& model,
                                  bool is_static, const SdfFrames& frames, const Placement& written,
                                  const Placement& X_WL, const Vector3d& scale) {
    std::vector<Obstacle> shapes;
    for (const Element* e = link.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string kind = e->Name();
      if (kind != "collision") {
        if (!known_link_elements.count(kind)) {
          xml.ignored_elements().add_harmless("<" + kind + "> in <link>", xml.where(*e));
        }
        continue;
      }
      std::optional<Obstacle> shape = read_obstacle(xml, *e, model, scale, is_static, meshes_);
      if (!shape) continue;
      // A plane stands still in a free model, and where <pose> puts it, whatever the state says.
      const bool is_plane = shape->kind == ShapeKind::plane;
      const Element* pose = e->FirstChildElement("pose");
      const Placement own = frames.find_pose(*e);
      const bool is_in_link =
          !pose || !pose->Attribute("relative_to") || is_at_most_sdf(xml, *e, 6);
      const Placement& base = is_plane ? written : X_WL;
      const Placement pose_W =
          is_in_link ? base * own : X_WL * frames.find_pose(link).inverse() * own;
      shape->position_W = pose_W.position;
      shape->orientation_W = pose_W.rotation;
      shape->model = model;
      shape->name = name_of(link) + "::" + name_of(*e);
      (is_plane && !is_static ? found_.obstacles : shapes).push_back(*shape);
    }
    return shapes;
  }

  const Xml& xml_;
  EmbeddedMeshes meshes_{xml_};
  const Element& world_;
  SavedState saved_;
  SdfFrames world_frames_;
  WorldModels found_;
  std::set<std::string> names_;
  static constexpr std::size_t most_models = 100000;  ///< nested includes may multiply

  std::map<std::string, const Element*> files_;  ///< embedded `<sdf>` by URI
  std::vector<const Element*> open_;             ///< those that are being read
  std::size_t count_ = 0;                        ///< models read
  std::vector<std::unique_ptr<Document>> documents_;
  std::vector<std::unique_ptr<Xml>> builtins_;
};

}  // namespace

void skip_plugin(const Xml& xml, const Element& plugin, const std::string& model) {
  const std::string name = xml.attribute(plugin, "name");
  const std::string filename = xml.attribute(plugin, "filename");
  if (xml.ignored_elements().ignores({name, filename})) return;
  if (decide_on_module(filename) == Handling::skip) {
    return xml.ignored_elements().add_harmless(filename, xml.where(plugin));
  }
  if (moves_air(filename)) {
    xml.fail(plugin, "plugin '" + name + "': " + filename +
                         " moves the air, and the vehicle would fly in calm air without it. Add "
                         "libwind_plugin.so to the vehicle." +
                         suggest_ignoring(filename));
  }
  xml.ignored_elements().add_unsimulated(filename + (model.empty() ? "" : " of " + model),
                                         xml.where(plugin));
}

WorldModels read_models(const Xml& xml, const Element& world) {
  return ModelReader(xml, world).read();
}

}  // namespace quadcore
