// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <oblique/console/console.h>
#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/parameter_setting.h>
#include <oblique/network/program/program.h>
#include <oblique/text/quantity.h>

namespace oblique::console {

/// A compiled diagram whose pots can be turned. Not installed.
class Pots {
 public:
  /// `library` must outlive it. Throws DiagramError and NetworkError.
  Pots(diagram::Diagram diagram, const diagram::BlockLibrary& library,
       std::vector<diagram::ParameterOverride> overrides = {});

  const diagram::Diagram& diagram() const { return diagram_; }
  /// The pots that were turned, and to what.
  const std::vector<diagram::ParameterOverride>& turned() const { return overrides_; }
  const std::shared_ptr<diagram::FlatDiagram>& flat() const { return flat_; }
  /// The equations with the pots as they are: the same one until a pot is turned.
  const std::shared_ptr<const network::Program>& program();

  /// Sets a parameter ("c.gain") or the weight of a wire ("c.in[2]") to a quantity ("1e4", "20 ms"). Throws
  /// DiagramError and NetworkError, and is then as it was.
  Turned turn(const std::string& pot, const std::string& value);
  /// The diagram with another timeline.
  void set_timeline(diagram::Timeline timeline);

  /// Of all parameters of flat blocks.
  std::vector<std::string> names() const;
  /// What a pot, or the weight of a wire, is set to, in the unit of the parameter.
  struct Setting {
    double value = 0;
    std::string unit;
  };
  std::optional<Setting> setting_of(std::string_view name) const;

 private:
  using Parameter = network::ParameterSetting::Parameter;

  /// A parameter of a flat block, which saves a pot that is turned often the way through the whole diagram.
  struct Known {
    std::size_t block, parameter;
    std::uint32_t number;
    text::Unit unit;
    std::size_t override;  ///< in `overrides_`
  };

  std::shared_ptr<diagram::FlatDiagram> flattened(
      const std::vector<diagram::ParameterOverride>& overrides) const;
  void compile(std::shared_ptr<diagram::FlatDiagram> flat);
  bool turn_known(const std::string& name, const std::string& value);
  std::optional<std::vector<Parameter>> changed(const diagram::FlatDiagram& now) const;

  diagram::Diagram diagram_;
  const diagram::BlockLibrary* library_;
  std::vector<diagram::ParameterOverride> overrides_;
  std::shared_ptr<diagram::FlatDiagram> flat_;
  std::shared_ptr<const network::Program> compiled_, program_;
  std::optional<network::ParameterNumbers> numbers_;
  std::optional<network::ParameterSetting> setting_;
  std::unordered_map<std::string, Known> known_;
  bool turned_ = false;  ///< since `program_` was made
};

}  // namespace oblique::console
