#include "included_models.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "embedded_meshes.hpp"
#include "model_path.hpp"
#include "old_sdf.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Node = tinyxml2::XMLNode;
using Element = Xml::Element;

/// Models in Gazebo's own folder; a light is no model.
const std::map<std::string, std::string> builtin_models = {
    {"model://sun", "<sdf version='1.6'><light name='sun'/></sdf>"},
    {"model://ground_plane",
     "<sdf version='1.6'><model name='ground_plane'><static>true</static><link name='link'>"
     "<collision name='collision'><geometry><plane><normal>0 0 1</normal><size>100 100</size>"
     "</plane></geometry><surface><friction><ode><mu>100</mu><mu2>50</mu2></ode></friction>"
     "</surface></collision></link></model></sdf>"}};

std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return escaped;
}

/// Return the URI of an include, or "".
std::string uri_of(const Element& include) {
  const Element* uri = include.FirstChildElement("uri");
  return uri && uri->GetText() ? trimmed(uri->GetText()) : "";
}

/// Return the name of a `<model>`, or that which an `<include>` gives to its model; else "".
std::string model_name_of(const Element& element) {
  const Element* own = element.FirstChildElement("name");
  if (element.Name() == std::string("model") && element.Attribute("name")) {
    return trimmed(element.Attribute("name"));
  }
  if (element.Name() == std::string("include") && own && own->GetText()) {
    return trimmed(own->GetText());
  }
  return "";
}

/// Return the message of an error, with a suggestion to ignore a model unless it has one.
std::string with_suggestion(const InputError& error, const std::string& name) {
  const std::string what = error.what();
  return what.find("--ignore") != std::string::npos ? what : what + suggest_ignoring(name);
}

/// Writes a world again, one node a line, with the models inside.
class Embedding {
 public:
  Embedding(const Document& world, const std::vector<std::string>& ignore)
      : world_(world), ignore_(ignore) {}

  Document embed() {
    IgnoredElements none;
    const Xml xml(world_, "sdf", none, old_sdf_root);
    chain_ = {world_.name};
    write_root(xml.root(), world_);
    return has_embedded_ ? result_ : world_;
  }

 private:
  void add_line(const std::string& line, const Document& source, int number) {
    const auto at = static_cast<std::size_t>(number) - 1;
    result_.text += line + "\n";
    result_.lines.push_back(at < source.lines.size() ? source.lines[at]
                                                     : std::make_pair(source.name, number));
  }

  void write_root(const Element& root, const Document& source) {
    const bool was_old = is_old_;
    is_old_ = root.Name() == std::string(old_sdf_root);
    has_embedded_ |= is_old_;
    write(root, source);
    is_old_ = was_old;
  }

  /// Write an element. Files of a model that the user ignores are not read.
  void write(const Element& element, const Document& source) {
    const std::string name = is_in_model_ ? "" : model_name_of(element);
    if (name.empty()) return write_inside(element, source);
    is_in_model_ = true;
    is_ignored_ = is_ignored(name);
    try {
      write_inside(element, source);
    } catch (const InputError& error) {
      throw InputError(with_suggestion(error, name));
    }
    is_in_model_ = is_ignored_ = false;
  }

  bool is_ignored(const std::string& name) const {
    return std::find(ignore_.begin(), ignore_.end(), name) != ignore_.end();
  }

  void write_inside(const Element& element, const Document& source) {
    const NewElement written = convert_element(element, is_old_);
    const std::string& name = written.name;
    const int number = element.GetLineNum();
    std::string line = "<" + name;
    for (const auto& [attribute, value] : written.attributes) {
      line += " " + attribute + "=\"" + escape(value) + "\"";
    }
    add_line(line + ">", source, number);
    if (!written.text.empty()) add_line(escape(written.text), source, number);
    for (const auto& [child, value] : written.children) {
      add_line("<" + child + ">" + escape(value) + "</" + child + ">", source, number);
    }
    for (const Node* node = element.FirstChild(); node; node = node->NextSibling()) {
      if (const Element* child = node->ToElement()) {
        write(*child, source);
      } else if (node->ToText()) {
        add_line(escape(node->Value()), source, node->GetLineNum());
      } else if (node->ToComment()) {
        add_line("<!-- -->", source, node->GetLineNum());
      }
    }
    if (!is_ignored_) {
      if (name == "include" && !element.FirstChildElement("sdf")) embed(element, source);
      if (name == "mesh") embed_triangles(element, source);
    }
    add_line("</" + name + ">", source, number);
  }

  void embed(const Element& include, const Document& source) {
    const std::string uri = uri_of(include);
    const std::string found = is_ignored(uri) ? "" : path_.find(uri);
    if (found.empty()) return;
    if (std::find(chain_.begin(), chain_.end(), found) != chain_.end()) {
      throw InputError(source.at(include.GetLineNum()) + ": '" + uri +
                       "' includes itself. Remove the <include>." + suggest_ignoring(uri));
    }
    if (!embedded_.insert(uri).second) return;
    const Document model = Document::read(found);
    has_embedded_ = true;
    chain_.push_back(found);
    try {
      IgnoredElements none;
      const Xml xml(model, "sdf", none, old_sdf_root);
      write_root(xml.root(), model);
    } catch (const InputError& error) {
      throw InputError(with_suggestion(error, uri));
    }
    chain_.pop_back();
  }

  /// Write the triangles of a `<mesh>` that something can touch, for the first one of its file.
  void embed_triangles(const Element& mesh, const Document& source) {
    const Element* geometry = mesh.Parent()->ToElement();
    const Element* collision = geometry ? geometry->Parent()->ToElement() : nullptr;
    if (!collision || collision->Name() != std::string("collision")) return;
    const std::string key = mesh_key(mesh);
    if (mesh.FirstChildElement(embedded_mesh)) embedded_.insert(key);
    const std::string found = path_.find_file(mesh_uri(mesh));
    if (found.empty() || !embedded_.insert(key).second) return;
    has_embedded_ = true;
    const std::string tag = embedded_mesh;
    std::istringstream lines("<" + tag + ">\n" + embed_mesh(found, mesh) + "\n</" + tag + ">");
    for (std::string line; std::getline(lines, line);) add_line(line, source, mesh.GetLineNum());
  }

  const Document& world_;
  const std::vector<std::string>& ignore_;
  ModelPath path_;
  Document result_{world_.name, ""};
  std::vector<std::string> chain_;  ///< files that contain one another, outermost first
  std::set<std::string> embedded_;  ///< URIs of models, and keys of meshes
  bool has_embedded_ = false;       ///< whether the result differs from the world
  bool is_in_model_ = false;        ///< whether a model of the world is written
  bool is_ignored_ = false;         ///< whether the user ignores that model
  bool is_old_ = false;             ///< whether the document that is written is SDF 1.0 to 1.2
};

}  // namespace

Document embed_models(const Document& world, const std::vector<std::string>& ignore) {
  return Embedding(world, ignore).embed();
}

std::string find_builtin_model(const std::string& uri) {
  const auto found = builtin_models.find(uri);
  return found == builtin_models.end() ? "" : found->second;
}

}  // namespace quadcore
