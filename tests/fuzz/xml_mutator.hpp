#pragma once

#include <tinyxml2.h>

#include <random>
#include <string>
#include <vector>

/// Bends XML documents along the grammar: elements come, go, move and double, attributes and texts
/// take values that mean something or nearly do. Readable text in, readable text out.
class XmlMutator {
 public:
  explicit XmlMutator(unsigned seed) : random_(seed) {}

  /// The text after a few mutations; as it was if it is no XML.
  std::string mutated(const std::string& text);
  /// The text with an element of the other in it.
  std::string crossed(const std::string& text, const std::string& other);

 private:
  using Document = tinyxml2::XMLDocument;
  using Element = tinyxml2::XMLElement;

  std::size_t below(std::size_t n) { return random_() % n; }
  bool chance(std::size_t one_in) { return below(one_in) == 0; }
  template <typename T>
  const T& any(const std::vector<T>& items) {
    return items[below(items.size())];
  }

  void mutate(Document& document);
  Element* add_child(Element& parent, const std::string& name, int depth);
  void set_value(Element& element);
  void nest(Element& element);
  std::string value(const std::string& of, const Document& document);
  std::string number();
  std::string child_name(const Element& parent);

  std::minstd_rand random_;
};
