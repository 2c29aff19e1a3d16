// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>

namespace oblique::diagram {

/// The text of a diagram under the hands of somebody who patches it: each change is one of the places that it
/// concerns, all else in the file stays as it is. A file that is wrong can be edited as long as it is TOML.
/// What it cannot change so throws DiagramError or ReadError, and leaves the text as it was. `library` must
/// outlive it.
class DiagramEdit {
 public:
  DiagramEdit(std::string text, std::string file, const BlockLibrary& library);

  const std::string& text() const { return text_; }

  /// Adds a block of a type, by this name or by one that is free where it is empty, and gives the name.
  std::string add(const std::string& type, const std::string& name = {});
  /// Removes a block with its wires, its place, and the outputs and expectations that show it.
  void remove(const std::string& block);
  /// Renames a block wherever the file names it.
  void rename(const std::string& block, const std::string& name);

  /// Wires a signal to an input: one more at one that adds, else in place of what is there. `weight` is a
  /// number other than 0.
  void connect(const std::string& signal, const std::string& block, const std::string& port,
               double weight = 1);
  void disconnect(const std::string& block, const std::string& port, std::size_t term);
  /// Sets the weight of a wire.
  void weigh(const std::string& block, const std::string& port, std::size_t term, double weight);

  /// Sets a parameter, the label or the type, to a text as a person writes it ("1e5", "10 Hz", "[[0, 1], [1,
  /// 2]]"); an empty one takes it away, so that its default applies.
  void set(const std::string& block, const std::string& key, const std::string& value);
  /// Sets "title", or an entry of a table ("run.until"), in the same way.
  void set_head(const std::string& path, const std::string& value);
  /// Gives places, as `[layout]` has them.
  void place(const std::vector<BlockPlace>& places);

  /// Adds an output of the diagram that shows a signal; an empty signal takes the output away.
  void show(const std::string& output, const std::string& signal);

 private:
  std::string text_, file_;
  const BlockLibrary* library_;
};

}  // namespace oblique::diagram
