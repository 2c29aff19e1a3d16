// SPDX-License-Identifier: MIT
#include <oblique/text/toml_edit.h>

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/document.h>
#include <oblique/text/toml_text.h>

namespace oblique::text {
namespace {

/// Thrown here where a place is not found as it should look; the caller says which entry it was.
struct NoPlace {};

/// A piece of the text that another one replaces.
struct Splice {
  std::size_t begin = 0, end = 0;
  std::string text;
};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Two values with the same content, wherever they stand; the order of keys makes no difference.
bool means_the_same(const Value& a, const Value& b) {
  if (a.kind != b.kind || a.elements.size() != b.elements.size() || a.entries.size() != b.entries.size())
    return false;
  if (a.boolean != b.boolean || a.text != b.text) return false;
  if (a.number != b.number && (a.number == a.number || b.number == b.number)) return false;
  return std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), means_the_same) &&
         std::all_of(a.entries.begin(), a.entries.end(), [&](const Entry& entry) {
           const Value* const other = b.find(entry.key);
           return other != nullptr && means_the_same(entry.value, *other);
         });
}

std::string path_text(const TomlPath& path) {
  std::string text;
  for (const auto& step : path) {
    if (const auto* const key = std::get_if<std::string>(&step)) {
      text += (text.empty() ? "" : ".") + *key;
    } else {
      text += fmt::format("[{}]", std::get<std::size_t>(step));
    }
  }
  return text;
}

Entry* find_entry(Value& table, const std::string& key) {
  const auto found = std::find_if(table.entries.begin(), table.entries.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  return found == table.entries.end() ? nullptr : &*found;
}

/// What a step of a path leads to, or nothing.
Value* stepped(Value& from, const std::variant<std::string, std::size_t>& step) {
  if (const auto* const key = std::get_if<std::string>(&step)) {
    Entry* const entry = from.kind == Value::Kind::table ? find_entry(from, *key) : nullptr;
    return entry == nullptr ? nullptr : &entry->value;
  }
  const std::size_t index = std::get<std::size_t>(step);
  return from.kind == Value::Kind::array && index < from.elements.size() ? &from.elements[index] : nullptr;
}

/// A text with the entries that it was read to have.
class TomlSource {
 public:
  TomlSource(std::string_view text, const std::string& file)
      : text_(text), root_(parse_document(text, file).root) {
    if (text_.starts_with("\xEF\xBB\xBF")) first_ = 3;
    lines_.push_back(first_);
    for (std::size_t at = first_; at < text_.size(); ++at) {
      if (text_[at] == '\n') lines_.push_back(at + 1);
    }
  }

  Value& root() { return root_; }

  bool has(const TomlPath& path) {
    Value* at = &root_;
    for (const auto& step : path) {
      at = stepped(*at, step);
      if (at == nullptr) return false;
    }
    return true;
  }
  /// Whether it is a table that ends with a line "key = value" and its break.
  bool has_lines(const TomlPath::value_type& table) {
    const Value* const found = stepped(root_, table);
    return found != nullptr && found->kind == Value::Kind::table && !found->entries.empty() &&
           !is_inline(*found) && is_line(found->entries.back()) && text_.ends_with('\n');
  }

  Splice splice_of(const TomlChange& change) {
    Value* parent = &root_;
    for (std::size_t k = 0; k + 1 < change.path.size(); ++k) {
      Value* const next = stepped(*parent, change.path[k]);
      if (next == nullptr) return with_new_table(change);
      parent = next;
    }
    Value* const value = stepped(*parent, change.path.back());
    if (value == nullptr) {
      if (change.kind != TomlChange::Kind::set) throw NoPlace{};
      return insertion(*parent, change);
    }
    if (change.kind == TomlChange::Kind::set) {
      const std::size_t begin = begin_of(*value);
      return {begin, end_of_value(begin), change.text};
    }
    return change.kind == TomlChange::Kind::remove ? removal(*parent, change) : renaming(*parent, change);
  }

 private:
  std::size_t offset(SourcePosition position) const {
    if (position.line < 1 || static_cast<std::size_t>(position.line) > lines_.size()) throw NoPlace{};
    std::size_t at = lines_[static_cast<std::size_t>(position.line) - 1];
    for (int column = 1; column < position.column; ++column) {
      if (at >= text_.size()) throw NoPlace{};
      ++at;
      while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U) ++at;
    }
    return at;
  }
  std::size_t begin_of(const Value& value) const { return offset(value.position); }

  char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }

  std::size_t line_begin(std::size_t place) const {
    const auto next = std::upper_bound(lines_.begin(), lines_.end(), place);
    return *(next - 1);
  }
  /// One past the line's end, its break included.
  std::size_t line_end(std::size_t place) const {
    const auto next = std::upper_bound(lines_.begin(), lines_.end(), place);
    return next == lines_.end() ? text_.size() : *next;
  }
  /// The break of lines that the text has.
  std::string line_break() const { return text_.find("\r\n") != std::string_view::npos ? "\r\n" : "\n"; }

  std::size_t end_of_value(std::size_t begin) const {
    const char first = at(begin);
    if (first == '"' || first == '\'') return end_of_string(text_, begin);
    if (first != '[' && first != '{') {
      std::size_t end = text_.find_first_of(",]}#\r\n", begin);
      end = std::min(end, text_.size());
      while (end > begin && is_blank(text_[end - 1])) --end;
      if (end == begin) throw NoPlace{};
      return end;
    }
    int depth = 0;
    for (std::size_t place = begin; place < text_.size();) {
      const char c = text_[place];
      if (c == '"' || c == '\'') {
        place = end_of_string(text_, place);
        continue;
      }
      if (c == '#') {
        place = std::min(text_.find('\n', place), text_.size());
        continue;
      }
      if (c == '[' || c == '{') ++depth;
      if ((c == ']' || c == '}') && --depth == 0) return place + 1;
      ++place;
    }
    throw NoPlace{};
  }

  std::size_t end_of_key(std::size_t begin) const {
    if (at(begin) == '"' || at(begin) == '\'') return end_of_string(text_, begin);
    const auto bare = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-';
    };
    std::size_t end = begin;
    while (bare(at(end))) ++end;
    if (end == begin) throw NoPlace{};
    return end;
  }

  /// The text between brackets or braces is on one line of a table, or is a table of its own lines.
  bool is_inline(const Value& table) const { return &table != &root_ && at(begin_of(table)) == '{'; }
  bool has_header(const Value& table) const {
    if (&table == &root_) return false;
    const std::size_t begin = begin_of(table);
    return at(begin) == '[' && is_alone(begin);
  }
  /// Whether nothing stands before it on its line.
  bool is_alone(std::size_t place) const {
    for (std::size_t k = line_begin(place); k < place; ++k) {
      if (!is_blank(text_[k])) return false;
    }
    return true;
  }

  /// An entry that is "key = value" in the lines of its table.
  bool is_line(const Entry& entry) const {
    const std::size_t key = offset(entry.position);
    if (!is_alone(key) || at(key) == '[') return false;
    std::size_t place = end_of_key(key);
    while (is_blank(at(place))) ++place;
    return at(place) == '=';
  }

  std::optional<std::size_t> equal_sign(std::size_t place) const {
    const std::size_t begin = line_begin(place), end = line_end(place);
    std::size_t k = begin;
    while (is_blank(at(k))) ++k;
    if (k >= end || at(k) == '#' || at(k) == '[' || at(k) == '\n' || at(k) == '\r') return std::nullopt;
    const std::size_t sign = text_.find('=', k);
    if (sign == std::string_view::npos || sign >= end) return std::nullopt;
    return sign - begin;
  }

  Splice with_new_table(const TomlChange& change) const {
    const auto* const table = change.path.empty() ? nullptr : std::get_if<std::string>(&change.path.front());
    if (change.kind != TomlChange::Kind::set || table == nullptr || change.path.size() != 2) throw NoPlace{};
    std::string text;
    if (!text_.empty() && text_.back() != '\n') text += line_break();
    if (text_.size() > first_) text += line_break();
    text += "[" + toml_key(*table) + "]" + line_break() + line_of(change);
    return {text_.size(), text_.size(), text};
  }

  static std::string key_of(const TomlChange& change) {
    const auto* const key = std::get_if<std::string>(&change.path.back());
    if (key == nullptr) throw NoPlace{};
    return toml_key(*key);
  }
  std::string line_of(const TomlChange& change) const {
    return key_of(change) + " = " + change.text + line_break();
  }

  /// A line for a new entry that looks like the one at `model`.
  std::string line_like(std::size_t model, const TomlChange& change) const {
    const std::size_t begin = line_begin(model);
    std::string text(text_.substr(begin, model - begin));
    text += key_of(change);
    const auto sign = equal_sign(model);
    const std::size_t spaces = sign && *sign > text.size() ? *sign - text.size() : 1;
    return text + std::string(spaces, ' ') + "= " + change.text + line_break();
  }

  Splice insertion(const Value& parent, const TomlChange& change) const {
    if (parent.kind == Value::Kind::array) return element_insertion(parent, change);
    if (parent.kind != Value::Kind::table) throw NoPlace{};
    if (is_inline(parent)) {
      const std::string entry = key_of(change) + " = " + change.text;
      const std::size_t begin = begin_of(parent), close = end_of_value(begin) - 1;
      if (parent.entries.empty()) return {begin, close + 1, "{ " + entry + " }"};
      return {end_of_last(parent), end_of_last(parent), ", " + entry};
    }
    const Entry* last = nullptr;
    for (const Entry& entry : parent.entries) {
      if (is_line(entry)) last = &entry;
    }
    if (last != nullptr) {
      const std::size_t end = line_end(end_of_value(begin_of(last->value)) - 1);
      const bool unfinished = end == text_.size() && text_.back() != '\n';
      return {end, end, (unfinished ? line_break() : "") + line_like(offset(last->position), change)};
    }
    if (has_header(parent)) {
      const std::size_t end = line_end(begin_of(parent));
      const bool unfinished = end == text_.size() && text_.back() != '\n';
      return {end, end, (unfinished ? line_break() : "") + line_of(change)};
    }
    if (&parent == &root_) return {first_, first_, line_of(change)};
    return with_new_table(change);
  }

  std::size_t end_of_last(const Value& parent) const {
    const Value& last =
        parent.kind == Value::Kind::array ? parent.elements.back() : parent.entries.back().value;
    return end_of_value(begin_of(last));
  }

  Splice element_insertion(const Value& array, const TomlChange& change) const {
    const std::size_t begin = begin_of(array);
    if (at(begin) != '[' || std::get<std::size_t>(change.path.back()) != array.elements.size())
      throw NoPlace{};
    if (array.elements.empty()) return {begin, end_of_value(begin), "[" + change.text + "]"};
    return {end_of_last(array), end_of_last(array), ", " + change.text};
  }

  Splice removal(const Value& parent, const TomlChange& change) const {
    if (parent.kind == Value::Kind::array || is_inline(parent)) return item_removal(parent, change);
    const Entry& entry = entry_of(parent, change);
    if (is_line(entry)) {
      const std::size_t key = offset(entry.position);
      return {line_begin(key), line_end(end_of_value(begin_of(entry.value)) - 1), ""};
    }
    if (!has_header(entry.value)) throw NoPlace{};
    // the lines of a table of its own, until the next header
    const std::size_t begin = line_begin(begin_of(entry.value));
    std::size_t end = line_end(begin_of(entry.value));
    for (const Entry& inner : entry.value.entries) {
      if (!is_line(inner)) throw NoPlace{};
      end = std::max(end, line_end(end_of_value(begin_of(inner.value)) - 1));
    }
    while (end < text_.size() && (at(end) == '\n' || at(end) == '\r')) end = line_end(end);
    return {begin, end, ""};
  }

  Splice item_removal(const Value& parent, const TomlChange& change) const {
    // of each item where it begins and ends
    std::vector<std::pair<std::size_t, std::size_t>> items;
    std::size_t which = 0;
    if (parent.kind == Value::Kind::array) {
      which = std::get<std::size_t>(change.path.back());
      for (const Value& element : parent.elements) {
        const std::size_t begin = begin_of(element);
        items.emplace_back(begin, end_of_value(begin));
      }
    } else {
      const auto& key = std::get<std::string>(change.path.back());
      for (const Entry& entry : parent.entries) {
        if (entry.key == key) which = items.size();
        items.emplace_back(offset(entry.position), end_of_value(begin_of(entry.value)));
      }
    }
    if (which > 0) return {items[which - 1].second, items[which].second, ""};
    if (items.size() > 1) return {items[0].first, items[1].first, ""};
    return {items[0].first, items[0].second, ""};
  }

  static const Entry& entry_of(const Value& parent, const TomlChange& change) {
    const auto& key = std::get<std::string>(change.path.back());
    return *std::find_if(parent.entries.begin(), parent.entries.end(),
                         [&](const Entry& entry) { return entry.key == key; });
  }

  /// Whether the line before or after has its equal sign in the same column.
  bool is_aligned(std::size_t place) const {
    const auto sign = equal_sign(place);
    const std::size_t begin = line_begin(place), end = line_end(place);
    return sign && ((begin > first_ && equal_sign(begin - 1) == sign) ||
                    (end < text_.size() && equal_sign(end) == sign));
  }

  Splice renaming(const Value& parent, const TomlChange& change) const {
    if (parent.kind != Value::Kind::table) throw NoPlace{};
    const Entry& entry = entry_of(parent, change);
    const std::size_t begin = offset(entry.position);
    std::size_t end = end_of_key(begin);
    std::string key = toml_key(change.text);
    if (is_line(entry) && is_aligned(begin)) {
      std::size_t spaces = 0;
      while (is_blank(at(end + spaces))) ++spaces;
      const std::size_t whole = end - begin + spaces;
      end += spaces;
      key += std::string(whole > key.size() ? whole - key.size() : 1, ' ');
    }
    return {begin, end, key};
  }

  std::string_view text_;
  Value root_;
  std::size_t first_ = 0;           ///< after a byte order mark
  std::vector<std::size_t> lines_;  ///< where each begins
};

/// What a change means.
bool apply(const TomlChange& change, const std::string& file, Value& root) {
  Value* parent = &root;
  for (std::size_t k = 0; k + 1 < change.path.size(); ++k) {
    Value* next = stepped(*parent, change.path[k]);
    if (next == nullptr) {
      const auto* const key = std::get_if<std::string>(&change.path[k]);
      if (key == nullptr || parent->kind != Value::Kind::table) return false;
      parent->entries.push_back({*key, {}, {}});
      next = &parent->entries.back().value;
    }
    parent = next;
  }
  const auto* const key = std::get_if<std::string>(&change.path.back());
  if (change.kind == TomlChange::Kind::set) {
    const Value value = parse_document("value = " + change.text, file).root.entries.front().value;
    if (Value* const old = stepped(*parent, change.path.back())) {
      *old = value;
    } else if (key != nullptr && parent->kind == Value::Kind::table) {
      parent->entries.push_back({*key, {}, value});
    } else if (key == nullptr && parent->kind == Value::Kind::array) {
      parent->elements.push_back(value);
    } else {
      return false;
    }
    return true;
  }
  if (stepped(*parent, change.path.back()) == nullptr) return false;
  if (key == nullptr) {
    if (change.kind == TomlChange::Kind::rename) return false;
    parent->elements.erase(parent->elements.begin() +
                           static_cast<std::ptrdiff_t>(std::get<std::size_t>(change.path.back())));
  } else if (change.kind == TomlChange::Kind::remove) {
    std::erase_if(parent->entries, [&](const Entry& entry) { return entry.key == *key; });
  } else {
    find_entry(*parent, *key)->key = change.text;
  }
  return true;
}

[[noreturn]] void refuse(const TomlChange& change, const std::string& file) {
  throw ReadError(Diagnostic{{file, {}},
                             fmt::format("'{}' cannot be changed as it is written", path_text(change.path)),
                             "an entry of a table, on a line of its own or between braces",
                             "change it in the text"});
}

/// How many of these changes one look at the text does: all that add entries to one table of lines.
std::size_t done_at_once(TomlSource& source, std::span<const TomlChange> changes) {
  std::set<TomlPath> added;
  const auto adds = [&](const TomlChange& change) {
    return added.insert(change.path).second && change.kind == TomlChange::Kind::set &&
           change.path.size() == 2 && change.path.front() == changes.front().path.front() &&
           source.has_lines(change.path.front()) && !source.has(change.path);
  };
  std::size_t count = 0;
  while (count < changes.size() && adds(changes[count])) ++count;
  return std::max<std::size_t>(count, 1);
}

/// Does the first of these changes, or some of them, and takes them out.
std::string edited(std::string_view text, const std::string& file, std::span<const TomlChange>& changes) {
  TomlSource source(text, file);
  const auto now = changes.first(done_at_once(source, changes));
  changes = changes.subspan(now.size());
  std::string result(text);
  try {
    Splice splice = source.splice_of(now.front());
    for (const TomlChange& more : now.subspan(1)) splice.text += source.splice_of(more).text;
    result.replace(splice.begin, splice.end - splice.begin, splice.text);
  } catch (const NoPlace&) {
    refuse(now.front(), file);
  }
  Value meant = source.root();
  for (const TomlChange& change : now) {
    if (!apply(change, file, meant)) refuse(change, file);
  }
  try {
    if (means_the_same(parse_document(result, file).root, meant)) return result;
  } catch (const ReadError&) {
    // said below: what is wrong in a text that nobody sees helps nobody
  }
  refuse(now.front(), file);
}

}  // namespace

std::string edit_toml(std::string_view text, const std::string& file,
                      const std::vector<TomlChange>& changes) {
  std::string result(text);
  for (std::span<const TomlChange> left = changes; !left.empty();) result = edited(result, file, left);
  return result;
}

}  // namespace oblique::text
