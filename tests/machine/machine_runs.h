// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

#include "../support/compiled.h"

namespace oblique::testing {

/// A diagram whose file has this text below its first line.
inline diagram::Diagram parsed(const std::string& text) {
  return diagram::parse_diagram("format = \"oblique-diagram/1\"\n" + text, "test.toml");
}

inline solve::Trajectory trajectory_of(const diagram::Diagram& diagram) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
  return solve::run(network::Program(network::assemble(flat)), flat, solve::options_of(diagram.run))
      .trajectory;
}

/// The greatest magnitude of a signal in a run of its own, at its rows.
inline double greatest_signal(const diagram::Diagram& diagram) {
  diagram::Diagram all = diagram;
  all.outputs.clear();  // then every signal is one
  all.expectations.clear();
  const solve::Trajectory run = trajectory_of(all);
  double most = 0;
  for (std::size_t r = 0; r < run.rows(); ++r) {
    for (std::size_t c = 1; c < run.columns().size(); ++c) most = std::max(most, std::abs(run.at(r, c)));
  }
  return most;
}

/// The largest difference of any output at any time, relative to the largest value of all.
inline double difference(const diagram::Diagram& one, const diagram::Diagram& other) {
  const solve::Trajectory a = trajectory_of(one), b = trajectory_of(other);
  EXPECT_EQ(a.rows(), b.rows());
  EXPECT_EQ(a.columns().size(), b.columns().size());
  double size = 0, off = 0;
  for (std::size_t c = 1; c < a.columns().size(); ++c) {
    EXPECT_EQ(a.columns()[c].name, b.columns()[c].name);
    for (std::size_t r = 0; r < a.rows(); ++r) {
      size = std::max(size, std::abs(a.at(r, c)));
      off = std::max(off, std::abs(a.at(r, c) - b.at(r, c)));
    }
  }
  return off / size;
}

/// What no machine with inputs of 1 and 10 and potentiometers from 0 to 1 could do.
inline void expect_machine_elements(const diagram::Diagram& diagram, bool with_signs) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, shipped_blocks());
  EXPECT_EQ(flat.blocks.size(), diagram.blocks.size()) << "composites";
  std::set<std::pair<std::string, std::string>> settings;
  for (const diagram::FlatBlock& b : flat.blocks) {
    for (std::size_t port = 0; port < b.inputs.size(); ++port) {
      const bool sum = b.definition->inputs[port].sum;
      for (const diagram::FlatTerm& term : b.inputs[port].terms) {
        const double weight = with_signs ? std::abs(term.weight) : term.weight;
        EXPECT_TRUE(weight == 1 || weight == 0 || (weight == 10 && (sum || with_signs)))
            << b.path << ": " << term.weight;
      }
    }
    if (b.definition->name != "potentiometer") continue;
    const double setting = b.parameters[b.definition->find_parameter("setting").value()];
    EXPECT_TRUE(setting > 0 && setting <= 1) << b.path << ": " << setting;
    const std::string from = flat.signal_name(b.inputs[0].terms.front().signal);
    EXPECT_TRUE(settings.emplace(from, std::to_string(setting)).second)
        << "a second potentiometer of " << setting << " at " << from;
  }
}

}  // namespace oblique::testing
