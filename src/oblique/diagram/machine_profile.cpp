// SPDX-License-Identifier: MIT
#include <oblique/diagram/machine_profile.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/block_definition.h>
#include <oblique/diagram/block_library.h>
#include <oblique/diagram/machine_reader.h>
#include <oblique/diagram/shipped_files.h>

namespace oblique::diagram {
namespace {

constexpr std::string_view kIdeal = "ideal";

/// The shipped machines, the ideal one first and then by name; each is read where it is first asked for.
class Shipped {
 public:
  static Shipped& all() {
    static Shipped machines;
    return machines;
  }

  const std::vector<std::string>& names() const { return names_; }

  const MachineProfile* find(std::string_view name) {
    const auto found = entries_.find(name);
    if (found == entries_.end()) return nullptr;
    const std::lock_guard lock(guard_);
    Entry& entry = found->second;
    if (!entry.profile) {
      entry.profile = parse_machine(entry.text, fmt::format("src/machines/{}.toml", name), std::string(name),
                                    BlockLibrary::shipped());
    }
    return &*entry.profile;
  }

 private:
  struct Entry {
    std::string_view text;
    std::optional<MachineProfile> profile;
  };

  Shipped() {
    for (const ShippedFile& file : shipped_machines()) {
      names_.emplace_back(file.name);
      entries_[names_.back()].text = file.text;
    }
    const auto rank = [](const std::string& name) { return std::pair(name != kIdeal, name); };
    std::sort(names_.begin(), names_.end(),
              [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  }

  std::mutex guard_;
  std::vector<std::string> names_;
  std::map<std::string, Entry, std::less<>> entries_;
};

/// Latin capitals made small; other letters stay.
std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

/// The words of a title, small, without its brackets and commas.
std::vector<std::string> words_of(std::string_view title) {
  std::string text = lower(title);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The machine that a slip of the hand, or a word of its title, may mean.
std::optional<std::string> nearest_machine(std::string_view name) {
  const std::string small = lower(name);
  if (auto nearest = text::nearest_name(small, machine_names())) return nearest;
  std::vector<std::string> words, machines;
  for (const std::string& machine : machine_names()) {
    for (std::string& word : words_of(find_machine(machine)->title)) {
      words.push_back(std::move(word));
      machines.push_back(machine);
    }
  }
  const auto nearest = text::nearest_name(small, words);
  if (!nearest) return std::nullopt;
  return machines[static_cast<std::size_t>(std::find(words.begin(), words.end(), *nearest) - words.begin())];
}

}  // namespace

std::optional<std::size_t> BlockFigure::acts_on(const BlockDefinition& definition) const {
  const bool same_role = role != Role::other && role == definition.role;
  return same_role || block == definition.name ? definition.find_parameter(parameter) : std::nullopt;
}

const ElementCount* MachineProfile::find(ElementKind kind) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const ElementCount& e) { return e.kind == kind; });
  return found == elements.end() ? nullptr : &*found;
}

const MachineProfile* find_machine(std::string_view name) {
  return Shipped::all().find(name);
}

std::vector<std::string> machine_names() {
  return Shipped::all().names();
}

text::Unit unit_on(std::string_view profile, std::string_view unit) {
  text::Unit wanted = text::parse_unit(unit).value_or(text::Unit{});
  wanted.machine = profile;
  if (profile == kIdeal) return wanted;
  if (const MachineProfile* const machine = find_machine(profile)) wanted.volts = machine->unit;
  return wanted;
}

text::Diagnostic unknown_machine(std::string_view name, text::Place place) {
  const auto nearest = nearest_machine(name);
  return {std::move(place),
          fmt::format("there is no machine '{}'", name),
          {},
          nearest ? text::Remedy{fmt::format("did you mean '{}'? ", *nearest), text::Action{"machines"},
                                 " lists all"}
                  : text::Remedy{text::Action{"machines"}, " lists those there are"}};
}

}  // namespace oblique::diagram
