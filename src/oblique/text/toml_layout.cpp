// SPDX-License-Identifier: MIT
#include <oblique/text/toml_layout.h>

#include <algorithm>
#include <map>
#include <utility>

#include <oblique/text/document.h>
#include <oblique/text/expression_grammar.h>
#include <oblique/text/toml_text.h>

namespace oblique::text {
namespace {

/// A character of a key without quotes.
bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Goes through a text once. It need not find mistakes: a text that is no TOML has been refused before.
class TomlScan {
 public:
  explicit TomlScan(std::string_view text) : text_(text) {
    if (text.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::vector<TomlItem> items() {
    for (skip_between(); at_ < text_.size(); skip_between())
      items_.push_back(here() == '[' ? header() : line());
    return std::move(items_);
  }

 private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_blanks() {
    while (here() != '\n' && here() != '\r') {
      const std::size_t blank = space_at(text_, at_);
      if (blank == 0) return;
      at_ += blank;
    }
  }
  /// Blanks, breaks of lines, comments and the commas of a list.
  void skip_between() {
    for (;;) {
      if (here() == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else if (here() == ',')
        ++at_;
      else if (const std::size_t blank = space_at(text_, at_); blank > 0)
        at_ += blank;
      else
        return;
    }
  }

  /// Appends the parts of a key to the path and to the item.
  void read_keys(TomlItem& item) {
    for (;;) {
      skip_blanks();
      const std::size_t begin = at_;
      std::string key;
      if (here() == '"' || here() == '\'') {
        at_ = end_of_string(text_, at_);
        // its escapes are read as those of a value are
        const std::string value = "key = " + std::string(text_.substr(begin, at_ - begin));
        key = parse_document(value, {}).root.entries.front().value.text;
      } else {
        while (is_bare(here())) ++at_;
        key = text_.substr(begin, at_ - begin);
      }
      item.keys.push_back({item.path.size(), begin, at_});
      item.path.emplace_back(std::move(key));
      skip_blanks();
      if (here() != '.') return;
      ++at_;
      // of tables in an array that were begun the last one is meant
      if (item.kind == TomlItem::Kind::header) step_into_last(item.path);
    }
  }

  void step_into_last(TomlPath& path) const {
    const auto array = tables_.find(path);
    if (array != tables_.end()) path.emplace_back(array->second - 1);
  }

  TomlItem header() {
    TomlItem item{TomlItem::Kind::header, {}, {}, at_, 0, 0, {}};
    const bool is_array = text_.substr(at_).starts_with("[[");
    at_ += is_array ? 2 : 1;
    read_keys(item);
    if (is_array) item.path.emplace_back(tables_[TomlPath(item.path)]++);
    at_ = std::min(at_ + (is_array ? 2 : 1), text_.size());
    item.end = item.value = at_;
    table_ = item.path;
    return item;
  }

  TomlItem line() {
    TomlItem item{TomlItem::Kind::line, table_, {}, at_, 0, 0, {}};
    read_assignment(item);
    return item;
  }

  void read_assignment(TomlItem& item) {
    read_keys(item);
    ++at_;  // the equal sign
    skip_blanks();
    read_value(item);
  }

  void read_value(TomlItem& item) {
    item.value = at_;
    const char first = here();
    if (first == '"' || first == '\'') {
      at_ = end_of_string(text_, at_);
    } else if (first == '[' || first == '{') {
      ++at_;
      for (skip_between(); at_ < text_.size() && here() != ']' && here() != '}'; skip_between())
        item.inner.push_back(inner_of(item, first == '{'));
      at_ = std::min(at_ + 1, text_.size());
    } else {
      at_ = std::min(text_.find_first_of(",]}#\r\n", at_ + 1), text_.size());
      while (text_[at_ - 1] == ' ' || text_[at_ - 1] == '\t') --at_;
    }
    item.end = at_;
  }

  TomlItem inner_of(const TomlItem& outer, bool is_entry) {
    TomlItem item{is_entry ? TomlItem::Kind::entry : TomlItem::Kind::element, outer.path, {}, at_, 0, 0, {}};
    if (is_entry) {
      read_assignment(item);
    } else {
      item.path.emplace_back(outer.inner.size());
      read_value(item);
    }
    return item;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  TomlPath table_;                          ///< that of the last header
  std::map<TomlPath, std::size_t> tables_;  ///< how many an array of tables has so far
  std::vector<TomlItem> items_;
};

}  // namespace

TomlPath TomlItem::table() const {
  const std::size_t own = kind == Kind::element ? 1 : keys.size();
  return {path.begin(), path.end() - static_cast<std::ptrdiff_t>(kind == Kind::header ? 0 : own)};
}

bool leads_through(const TomlPath& path, const TomlPath& other) {
  return other.size() <= path.size() && std::equal(other.begin(), other.end(), path.begin());
}

std::vector<TomlItem> toml_layout(std::string_view text) {
  return TomlScan(text).items();
}

}  // namespace oblique::text
