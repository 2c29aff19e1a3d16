// SPDX-License-Identifier: MIT
#include <oblique/text/toml_edit.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/document.h>
#include <oblique/text/toml_layout.h>
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
using Splices = std::vector<Splice>;

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

/// A text with what is written in it, and where.
class TomlSource {
 public:
  explicit TomlSource(std::string_view text) : text_(text), items_(toml_layout(text)) {
    if (text_.starts_with("\xEF\xBB\xBF")) first_ = 3;
  }

  /// What does a change; nothing, where it is not found as it should look.
  Splices splices_of(const TomlChange& change) const {
    if (change.path.empty()) throw NoPlace{};
    if (change.kind == TomlChange::Kind::remove) return removal(change.path);
    if (change.kind == TomlChange::Kind::rename) return renaming(change);
    if (const TomlItem* const item = item_at(items_, change.path))
      return {{item->value, item->end, change.text}};
    if (is_written(items_, change.path)) throw NoPlace{};  // a table that is not written at one place
    return {insertion(change)};
  }

  /// Whether it sets a value that there is, or adds a line to a table that there is: then all other places
  /// stay.
  bool is_plain(const TomlChange& change) const {
    if (change.kind != TomlChange::Kind::set || change.path.empty()) return false;
    if (item_at(items_, change.path) != nullptr) return true;
    return text_.ends_with('\n') && last_of({change.path.begin(), change.path.end() - 1}) != nullptr;
  }

 private:
  using Items = std::vector<TomlItem>;

  /// The line, entry or element of a path.
  static const TomlItem* item_at(const Items& items, const TomlPath& path) {
    for (const TomlItem& item : items) {
      if (item.kind == TomlItem::Kind::header || !leads_through(path, item.path)) continue;
      if (item.path.size() == path.size()) return &item;
      if (const TomlItem* const inner = item_at(item.inner, path)) return inner;
    }
    return nullptr;
  }
  /// Whether anything stands at a path, or below it.
  static bool is_written(const Items& items, const TomlPath& path) {
    return std::any_of(items.begin(), items.end(), [&](const TomlItem& item) {
      return leads_through(item.path, path) ||
             (leads_through(path, item.path) && is_written(item.inner, path));
    });
  }

  char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }
  std::size_t line_begin(std::size_t place) const {
    const std::size_t before = place == 0 ? std::string_view::npos : text_.rfind('\n', place - 1);
    return before == std::string_view::npos ? first_ : before + 1;
  }
  /// One past the line's end, its break included.
  std::size_t line_end(std::size_t place) const {
    const std::size_t end = text_.find('\n', place);
    return end == std::string_view::npos ? text_.size() : end + 1;
  }
  /// The break of lines that the text has.
  std::string line_break() const { return text_.find("\r\n") != std::string_view::npos ? "\r\n" : "\n"; }

  /// The column of a line's equal sign.
  std::optional<std::size_t> equal_sign(std::size_t place) const {
    const std::size_t begin = line_begin(place), end = line_end(place);
    std::size_t k = begin;
    while (is_blank(at(k))) ++k;
    if (k >= end || at(k) == '#' || at(k) == '[' || at(k) == '\n' || at(k) == '\r') return std::nullopt;
    const std::size_t sign = text_.find('=', k);
    if (sign == std::string_view::npos || sign >= end) return std::nullopt;
    return sign - begin;
  }
  /// Whether the line before or after has its equal sign in the same column.
  bool is_aligned(std::size_t place) const {
    const auto sign = equal_sign(place);
    const std::size_t begin = line_begin(place), end = line_end(place);
    return sign && ((begin > first_ && equal_sign(begin - 1) == sign) ||
                    (end < text_.size() && equal_sign(end) == sign));
  }

  /// A key as the text has it, with what it writes before it on the way there: "blocks.x.".
  std::string key_of(const TomlChange& change, const TomlItem* beside = nullptr) const {
    const auto* const key = std::get_if<std::string>(&change.path.back());
    if (key == nullptr) throw NoPlace{};
    std::string dotted;
    if (beside != nullptr) {
      for (const TomlKey& part : beside->keys) {
        if (part.depth + 1 < change.path.size())
          dotted += std::string(text_.substr(part.begin, part.end - part.begin)) + ".";
      }
    }
    return dotted + toml_key(*key);
  }
  std::string line_of(const TomlChange& change) const {
    return key_of(change) + " = " + change.text + line_break();
  }
  /// A line in the place behind another one; the break that the text's last line has not.
  Splice line_behind(std::size_t place, std::string line) const {
    const std::size_t end = line_end(place);
    const bool unfinished = end == text_.size() && text_.back() != '\n';
    return {end, end, (unfinished ? line_break() : "") + std::move(line)};
  }
  /// A new line behind one that it looks like.
  Splice line_like(const TomlItem& model, const TomlChange& change) const {
    const std::size_t begin = line_begin(model.begin);
    std::string line(text_.substr(begin, model.begin - begin));
    line += key_of(change, &model);
    const bool has_column = model.keys.size() == 1 || is_aligned(model.begin);
    const auto sign = has_column ? equal_sign(model.begin) : std::nullopt;
    const std::size_t spaces = sign && *sign > line.size() ? *sign - line.size() : 1;
    return line_behind(model.end - 1, line + std::string(spaces, ' ') + "= " + change.text + line_break());
  }

  Splice insertion(const TomlChange& change) const {
    const TomlPath parent(change.path.begin(), change.path.end() - 1);
    if (const TomlItem* const item = item_at(items_, parent)) return insertion_in(*item, change);
    if (const TomlItem* const beside = dotted_in(items_, parent)) {
      if (beside->kind == TomlItem::Kind::line) return line_like(*beside, change);
      return {beside->end, beside->end, ", " + key_of(change, beside) + " = " + change.text};
    }
    if (const TomlItem* const last = last_of(parent))
      return last->kind == TomlItem::Kind::line ? line_like(*last, change)
                                                : line_behind(last->begin, line_of(change));
    if (parent.empty()) return {first_, first_, line_of(change)};
    return with_new_table(change);
  }

  /// The last line of a table, or its header.
  const TomlItem* last_of(const TomlPath& table) const {
    const TomlItem* last = nullptr;
    for (const TomlItem& item : items_) {
      const bool is_header = item.kind == TomlItem::Kind::header;
      if (item.table() == table && (!is_header || last == nullptr)) last = &item;
    }
    return last;
  }
  /// The last line or entry that writes the last step to a table before a dot.
  static const TomlItem* dotted_in(const Items& items, const TomlPath& table) {
    const TomlItem* last = nullptr;
    for (const TomlItem& item : items) {
      const bool writes = item.kind != TomlItem::Kind::header && leads_through(item.path, table) &&
                          std::any_of(item.keys.begin(), item.keys.end(),
                                      [&](const TomlKey& key) { return key.depth + 1 == table.size(); });
      if (writes) last = &item;
      if (!leads_through(table, item.path)) continue;
      if (const TomlItem* const inner = dotted_in(item.inner, table)) last = inner;
    }
    return last;
  }

  Splice insertion_in(const TomlItem& outer, const TomlChange& change) const {
    const auto* const index = std::get_if<std::size_t>(&change.path.back());
    const bool is_list = at(outer.value) == '[';
    if (is_list ? index == nullptr || *index != outer.inner.size() : at(outer.value) != '{') throw NoPlace{};
    const std::string text = is_list ? change.text : key_of(change) + " = " + change.text;
    if (outer.inner.empty()) return {outer.value, outer.end, is_list ? "[" + text + "]" : "{ " + text + " }"};
    return {outer.inner.back().end, outer.inner.back().end, ", " + text};
  }

  Splice with_new_table(const TomlChange& change) const {
    const auto* const table = std::get_if<std::string>(&change.path.front());
    if (table == nullptr || change.path.size() != 2) throw NoPlace{};
    std::string text;
    if (!text_.empty() && text_.back() != '\n') text += line_break();
    if (text_.size() > first_) text += line_break();
    text += "[" + toml_key(*table) + "]" + line_break() + line_of(change);
    return {text_.size(), text_.size(), text};
  }

  Splices removal(const TomlPath& path) const {
    Splices splices;
    for (auto item = items_.begin(); item != items_.end(); ++item) {
      if (!leads_through(item->path, path)) {
        if (leads_through(path, item->path)) remove_inside(*item, path, splices);
        continue;
      }
      const std::size_t begin = line_begin(item->begin);
      std::size_t end = line_end(item->end - 1);
      if (item->kind == TomlItem::Kind::header) {  // the lines of a table of its own, until the next header
        while (std::next(item) != items_.end() && std::next(item)->kind == TomlItem::Kind::line)
          end = line_end((++item)->end - 1);
        while (end < text_.size() && (at(end) == '\n' || at(end) == '\r')) end = line_end(end);
      }
      splices.push_back({begin, end, ""});
    }
    return splices;
  }

  /// With the commas that are too many then.
  static void remove_inside(const TomlItem& outer, const TomlPath& path, Splices& splices) {
    const Items& items = outer.inner;
    for (std::size_t k = 0; k < items.size(); ++k) {
      if (!leads_through(items[k].path, path)) {
        if (leads_through(path, items[k].path)) remove_inside(items[k], path, splices);
        continue;
      }
      const std::size_t first = k;
      while (k + 1 < items.size() && leads_through(items[k + 1].path, path)) ++k;
      if (first > 0) {
        splices.push_back({items[first - 1].end, items[k].end, ""});
      } else {
        splices.push_back({items[0].begin, k + 1 < items.size() ? items[k + 1].begin : items[k].end, ""});
      }
    }
  }

  Splices renaming(const TomlChange& change) const {
    Splices splices;
    if (std::holds_alternative<std::string>(change.path.back())) rename_in(items_, change, splices);
    return splices;
  }
  void rename_in(const Items& items, const TomlChange& change, Splices& splices) const {
    const TomlPath& path = change.path;
    for (const TomlItem& item : items) {
      if (leads_through(path, item.path) && item.path.size() < path.size())
        rename_in(item.inner, change, splices);
      if (!leads_through(item.path, path)) continue;
      for (const TomlKey& key : item.keys) {
        if (key.depth + 1 != path.size()) continue;
        const std::string name = toml_key(change.text);
        splices.push_back({key.begin, key.end, name});
        if (item.kind != TomlItem::Kind::line || !is_aligned(item.begin)) continue;
        // its equal sign stays in its column, if there is room
        const std::size_t begin = item.keys.back().end, sign = text_.find('=', begin);
        const std::size_t whole = key.end - key.begin + sign - begin;
        splices.push_back({begin, sign, std::string(whole > name.size() ? whole - name.size() : 1, ' ')});
      }
    }
  }

  std::string_view text_;
  std::size_t first_ = 0;  ///< after a byte order mark
  std::vector<TomlItem> items_;
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

/// How many of these changes one look at the text does.
std::size_t done_at_once(const TomlSource& source, std::span<const TomlChange> changes) {
  const auto is_apart = [&](std::size_t count) {
    const TomlPath& path = changes[count].path;
    return std::none_of(changes.begin(), changes.begin() + static_cast<std::ptrdiff_t>(count),
                        [&](const TomlChange& before) {
                          return leads_through(before.path, path) || leads_through(path, before.path);
                        });
  };
  std::size_t count = 1;
  while (count < changes.size() && source.is_plain(changes[count - 1]) && source.is_plain(changes[count]) &&
         is_apart(count))
    ++count;
  return count;
}

std::string spliced(std::string_view text, Splices splices) {
  std::stable_sort(splices.begin(), splices.end(),
                   [](const Splice& a, const Splice& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t copied = 0;
  for (const Splice& splice : splices) {
    result += text.substr(copied, splice.begin - copied);
    result += splice.text;
    copied = splice.end;
  }
  return result += text.substr(copied);
}

/// Does the first of these changes, or some of them, and takes them out.
std::string edited(std::string_view text, const std::string& file, std::span<const TomlChange>& changes) {
  Value meant = parse_document(text, file).root;
  const TomlSource source(text);
  const auto now = changes.first(done_at_once(source, changes));
  changes = changes.subspan(now.size());
  Splices splices;
  try {
    for (const TomlChange& change : now) {
      Splices more = source.splices_of(change);
      std::move(more.begin(), more.end(), std::back_inserter(splices));
    }
  } catch (const NoPlace&) {
    refuse(now.front(), file);
  }
  for (const TomlChange& change : now) {
    if (!apply(change, file, meant)) refuse(change, file);
  }
  try {
    std::string result = spliced(text, std::move(splices));
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
