#include "xml_limits.hpp"

#include <string>

#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"

namespace quadcore {
namespace {

[[noreturn]] void fail(const Document& document, int line, const std::string& what) {
  throw InputError(document.at(line) + ": " + what);
}

/// Accept only UTF-8 without control characters other than white space. The parser stops at a NUL.
void check_text(const Document& document) {
  const std::string& text = document.text;
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const std::size_t size = character_size(text, at);
    if (size == 0) fail(document, line, "the text is not UTF-8. Save the file as UTF-8.");
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t') {
      fail(document, line, "the text contains a control character. Remove it.");
    }
    if (c == '\n') ++line;
    at += size;
  }
}

/// Scans the markup of a text without building a tree. Malformed markup is left to the parser,
/// which reports it.
class MarkupWalk {
 public:
  explicit MarkupWalk(const Document& document) : document_(document), text_(document.text) {}

  void check() {
    while (at_ < text_.size()) {
      if (begins("<!--")) {
        skip_past("-->");
      } else if (begins("<![CDATA[")) {
        skip_past("]]>");
      } else if (begins("<?") || begins("<!")) {
        skip_past(">");
      } else if (text_[at_] == '<') {
        check_tag();
      } else {
        advance();
      }
    }
  }

 private:
  bool begins(const char* mark) const {
    return text_.compare(at_, std::char_traits<char>::length(mark), mark) == 0;
  }

  void advance() { line_ += text_[at_++] == '\n'; }

  void skip_past(const std::string& mark) {
    const std::size_t end = text_.find(mark, at_);
    const std::size_t next = end == std::string::npos ? text_.size() : end + mark.size();
    while (at_ < next) advance();
  }

  void check_tag() {
    const bool closes = begins("</");
    int attributes = 0;
    for (advance(); at_ < text_.size() && text_[at_] != '>'; advance()) {
      const char quote = text_[at_];
      if (quote != '"' && quote != '\'') continue;
      if (++attributes > Document::most_attributes) {
        fail(document_, line_,
             "an element has more than " + std::to_string(Document::most_attributes) +
                 " attributes. Use a valid model or world file.");
      }
      for (advance(); at_ < text_.size() && text_[at_] != quote;) advance();
      if (at_ == text_.size()) return;
    }
    const bool empty = text_[at_ - 1] == '/';
    if (closes) {
      --level_;
    } else if (!empty && ++level_ > Document::most_levels) {
      fail(document_, line_,
           "elements are nested deeper than " + std::to_string(Document::most_levels) +
               " levels. Use a valid model or world file.");
    }
  }

  const Document& document_;
  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  int level_ = 0;
};

}  // namespace

void check_xml_limits(const Document& document, std::size_t largest) {
  if (document.text.size() > largest) {
    throw InputError(document.name + ": the file exceeds the limit of " +
                     std::to_string(largest / 1000000) + " MB. Use a smaller file.");
  }
  check_text(document);
  MarkupWalk(document).check();
}

}  // namespace quadcore
