#include "included_models.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "model_path.hpp"
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

/// Writes a world again, one node a line, with the models inside.
class Embedding {
 public:
  Embedding(const Document& world, const std::vector<std::string>& ignore)
      : world_(world), ignore_(ignore) {}

  Document embed() {
    IgnoredElements none;
    const Xml xml(world_, "sdf", none);
    chain_ = {world_.name};
    write(xml.root(), world_);
    return has_embedded_ ? result_ : world_;
  }

 private:
  void add_line(const std::string& line, const Document& source, int number) {
    const auto at = static_cast<std::size_t>(number) - 1;
    result_.text += line + "\n";
    result_.lines.push_back(at < source.lines.size() ? source.lines[at]
                                                     : std::make_pair(source.name, number));
  }

  void write(const Element& element, const Document& source) {
    const std::string name = element.Name();
    std::string line = "<" + name;
    for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
      line += std::string(" ") + a->Name() + "=\"" + escape(a->Value()) + "\"";
    }
    add_line(line + ">", source, element.GetLineNum());
    for (const Node* node = element.FirstChild(); node; node = node->NextSibling()) {
      if (const Element* child = node->ToElement()) {
        write(*child, source);
      } else if (node->ToText()) {
        add_line(escape(node->Value()), source, node->GetLineNum());
      } else if (node->ToComment()) {
        add_line("<!-- -->", source, node->GetLineNum());
      }
    }
    if (name == "include" && !element.FirstChildElement("sdf")) embed(element, source);
    add_line("</" + name + ">", source, element.GetLineNum());
  }

  void embed(const Element& include, const Document& source) {
    const std::string uri = uri_of(include);
    const auto found = std::find(ignore_.begin(), ignore_.end(), uri) == ignore_.end()
                           ? path_.find(uri)
                           : std::string();
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
      const Xml xml(model, "sdf", none);
      write(xml.root(), model);
    } catch (const InputError& error) {
      const std::string what = error.what();
      const bool suggests = what.find("--ignore") != std::string::npos;
      throw InputError(what + (suggests ? "" : suggest_ignoring(uri)));
    }
    chain_.pop_back();
  }

  const Document& world_;
  const std::vector<std::string>& ignore_;
  ModelPath path_;
  Document result_{world_.name, ""};
  std::vector<std::string> chain_;  ///< files that contain one another, outermost first
  std::set<std::string> embedded_;  ///< URIs
  bool has_embedded_ = false;
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
