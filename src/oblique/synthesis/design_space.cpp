// SPDX-License-Identifier: MIT
#include <oblique/synthesis/design_space.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/quantity.h>
#include <oblique/text/table_reader.h>

namespace oblique::synthesis {
namespace {

/// A number that could be freed.
struct Number {
  std::string name;
  const text::Value* value;
  bool is_length;  ///< above zero; otherwise a coordinate
};

void add_coordinates(const std::string& name, const text::Value& pair, std::vector<Number>& numbers) {
  numbers.push_back({name + ".x", &pair.elements[0], false});
  numbers.push_back({name + ".y", &pair.elements[1], false});
}

/// All numbers of a document that has been read as a mechanism without findings.
std::vector<Number> numbers_of(const text::Document& document) {
  std::vector<Number> numbers;
  for (const text::Entry& body : document.root.find("bodies")->entries) {
    if (const text::Value* const length = body.value.find("length"))
      numbers.push_back({body.key, length, true});
    if (const text::Value* const sides = body.value.find("sides")) {
      for (std::size_t i = 0; i < sides->elements.size(); ++i) {
        numbers.push_back({fmt::format("{}.sides.{}", body.key, i + 1), &sides->elements[i], true});
      }
    }
    const text::Value* const marks = body.value.find("marks");
    if (marks == nullptr) continue;
    for (const text::Entry& mark : marks->entries) {
      add_coordinates(body.key + "." + mark.key, mark.value, numbers);
    }
  }
  for (const text::Entry& point : document.root.find("frame")->entries) {
    add_coordinates(point.key, point.value, numbers);
  }
  return numbers;
}

class DimensionReader {
 public:
  DimensionReader(std::string_view text, const text::Document& document,
                  const mechanism::Mechanism& mechanism)
      : text_(text), document_(document), mechanism_(mechanism), numbers_(numbers_of(document)) {}

  std::vector<Dimension> read(std::span<const std::string> free) {
    for (const std::string& wanted : free) read(wanted);
    if (free.empty()) report("no dimension is free", "names such as " + example(), {});
    if (!findings_.empty()) throw SynthesisError(std::move(findings_));
    return std::move(dimensions_);
  }

 private:
  void read(const std::string& wanted) {
    const std::size_t equals = wanted.find('=');
    const std::string name = wanted.substr(0, equals);
    const std::vector<const Number*> named = find(name);
    if (named.empty()) {
      report_unknown(name);
    } else if (equals == std::string::npos) {
      for (const Number* number : named) add(*number, std::nullopt);
    } else if (named.size() > 1) {
      std::string remedy = "give each its own: ";
      for (const Number* number : named) {
        remedy += fmt::format("{}{}={}", number == named.front() ? "" : ",", number->name,
                              wanted.substr(equals + 1));
      }
      report(fmt::format("'{}' is {} numbers, which '{}' bounds together", name, named.size(), wanted),
             "bounds of one number", std::move(remedy));
    } else if (const auto bounds = read_bounds(wanted, equals + 1, *named.front())) {
      add(*named.front(), bounds);
    }
  }

  /// The number of that name, or else those whose names continue it.
  std::vector<const Number*> find(const std::string& name) const {
    std::vector<const Number*> found;
    for (const Number& number : numbers_) {
      if (number.name == name) return {&number};
      if (number.name.starts_with(name + ".")) found.push_back(&number);
    }
    if (mechanism_.find_body(name)) found.clear();
    return found;
  }

  struct Bounds {
    double lower;
    double upper;
  };

  std::optional<Bounds> read_bounds(const std::string& wanted, std::size_t begin, const Number& number) {
    const std::size_t dots = wanted.find("..", begin);
    if (dots == std::string::npos) {
      report(fmt::format("'{}' does not have two bounds", wanted), number.name + "=lower..upper", {});
      return std::nullopt;
    }
    const std::string to = wanted.substr(dots + 2);
    const auto lower = read_bound(wanted, text::with_unit_of(wanted.substr(begin, dots - begin), to), number);
    const auto upper = read_bound(wanted, to, number);
    if (!lower || !upper) return std::nullopt;
    if (*lower > *upper) {
      report(fmt::format("the bounds of '{}' are the wrong way round", wanted), "lower..upper",
             fmt::format("{}={}..{}", number.name, *upper, *lower));
      return std::nullopt;
    }
    if (*lower == *upper) {
      report(fmt::format("the bounds of '{}' leave no room", wanted), "a lower bound below the upper one",
             fmt::format("leave '{}' out and write {} into the file", number.name, *lower));
      return std::nullopt;
    }
    return Bounds{*lower, *upper};
  }

  std::optional<double> read_bound(const std::string& wanted, const std::string& text, const Number& number) {
    double bound = 0;
    try {
      bound = text::parse_quantity(text, text::parse_unit(mechanism_.length_unit).value());
    } catch (const text::ExpressionError& error) {
      report(fmt::format("bound '{}' of '{}': {}", text, wanted, error.what), error.expected,
             error.remedy.empty() ? fmt::format("{}=lower..upper", number.name) : error.remedy);
      return std::nullopt;
    }
    if (!std::isfinite(bound)) {
      report(fmt::format("bound '{}' of '{}' is {}", text, wanted, bound), "finite bounds", {});
      return std::nullopt;
    }
    if (number.is_length && !(bound > 0)) {
      report(fmt::format("bound '{}' of '{}' is {}", text, wanted, bound), "lengths above 0", {});
      return std::nullopt;
    }
    return bound;
  }

  void add(const Number& number, std::optional<Bounds> bounds) {
    if (std::any_of(dimensions_.begin(), dimensions_.end(),
                    [&](const Dimension& d) { return d.name == number.name; })) {
      report(fmt::format("'{}' is freed twice", number.name), {}, "name it once");
      return;
    }
    text::Diagnostics none;  // the mechanism has been read already
    const double value =
        text::read_quantity(document_.file, *number.value, mechanism_.length_unit, number.name, none).value();
    if (!bounds) {
      const double reach = mechanism_.largest_length() / 2;
      bounds = number.is_length ? Bounds{value / 2, 2 * value} : Bounds{value - reach, value + reach};
    }
    dimensions_.push_back({number.name, range_of(text_, *number.value), value, bounds->lower, bounds->upper});
  }

  void report_unknown(const std::string& name) {
    if (mechanism_.find_body(name)) {
      report(fmt::format("body '{}' is given by its sides and has no length", name),
             fmt::format("'{0}.sides', or one of them: '{0}.sides.1'", name), {});
      return;
    }
    if (const auto point = mechanism_.find_point(name)) {
      std::vector<std::string> marks;
      for (const Number& number : numbers_) {
        if (number.name.ends_with("." + name + ".x"))
          marks.push_back(number.name.substr(0, number.name.size() - 2));
      }
      report(fmt::format("point '{}' moves; its place is no dimension", name),
             "a body, a mark of a body, or a point of the frame",
             marks.empty() ? fmt::format("free a body that carries it: '{}'",
                                         mechanism_.bodies[mechanism_.bodies_at(*point).front()].name)
                           : fmt::format("as a mark it is called '{}'", marks.front()));
      return;
    }
    report(fmt::format("'{}' is no dimension of the mechanism", name), {}, text::suggest(name, names()));
  }

  /// What may be freed, the short names first.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Number& number : numbers_) {
      const std::size_t last = number.name.rfind('.');
      const std::string group = number.name.substr(0, last);
      if (last != std::string::npos && std::count(all.begin(), all.end(), group) == 0) all.push_back(group);
      if (last == std::string::npos) all.push_back(number.name);
    }
    return all;
  }

  std::string example() const { return "'" + names().front() + "'"; }

  void report(const std::string& what, std::string expected, std::string remedy) {
    findings_.push_back(
        {{mechanism_.file, {}}, "free dimensions: " + what, std::move(expected), std::move(remedy)});
  }

  std::string_view text_;
  const text::Document& document_;
  const mechanism::Mechanism& mechanism_;
  std::vector<Number> numbers_;
  std::vector<Dimension> dimensions_;
  std::vector<text::Diagnostic> findings_;
};

}  // namespace

DesignSpace::DesignSpace(std::string text, const std::string& file, std::span<const std::string> free)
    : text_(std::move(text)), original_(mechanism::parse_mechanism(text_, file)) {
  const text::Document document = text::parse_document(text_, file);
  dimensions_ = DimensionReader(text_, document, original_).read(free);
}

Eigen::VectorXd DesignSpace::values() const {
  Eigen::VectorXd values(std::ssize(dimensions_));
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = dimensions_[static_cast<std::size_t>(i)].value;
  return values;
}

Eigen::VectorXd DesignSpace::lower() const {
  Eigen::VectorXd bounds(std::ssize(dimensions_));
  for (Eigen::Index i = 0; i < bounds.size(); ++i) bounds[i] = dimensions_[static_cast<std::size_t>(i)].lower;
  return bounds;
}

Eigen::VectorXd DesignSpace::upper() const {
  Eigen::VectorXd bounds(std::ssize(dimensions_));
  for (Eigen::Index i = 0; i < bounds.size(); ++i) bounds[i] = dimensions_[static_cast<std::size_t>(i)].upper;
  return bounds;
}

std::string DesignSpace::text(const Eigen::VectorXd& values) const {
  std::vector<Replacement> replacements;
  for (std::size_t i = 0; i < dimensions_.size(); ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    if (value != dimensions_[i].value)
      replacements.push_back({dimensions_[i].range, fmt::format("{}", value)});
  }
  return replace_ranges(text_, std::move(replacements));
}

mechanism::Mechanism DesignSpace::mechanism(const Eigen::VectorXd& values) const {
  return mechanism::parse_mechanism(text(values), original_.file);
}

}  // namespace oblique::synthesis
