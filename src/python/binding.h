// SPDX-License-Identifier: MIT
// What the units of the Python module share. They only hand over: what is for Python's users (names,
// defaults, the checks of arguments, tables) is written in Python, in the package beside them.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/text/diagnostic.h>
#include <oblique/text/table_file.h>

namespace oblique::python {

namespace py = pybind11;

using Library = std::shared_ptr<diagram::BlockLibrary>;

/// Thrown through the library where Python has a signal to handle; the exception of its handler goes on in
/// `unlocked`.
struct Interrupt {};

/// Lets Python's signal handlers run while its lock is released: Ctrl-C is one. It looks every twentieth of a
/// second, and in the main thread alone, where Python has its handlers.
class SignalWatch {
 public:
  SignalWatch();

  /// Whether a handler has thrown: the work is to end.
  bool asked();
  /// The same for who asks at every step: beside that of a small diagram the clock takes long.
  bool asked_often() {
    constexpr unsigned kCallsALook = 64;
    return thrown_ ? true : ++calls_ % kCallsALook == 0 && asked();
  }
  /// Throws Interrupt then.
  void check() {
    if (asked()) throw Interrupt{};
  }
  /// `check` as a library's function for progress.
  std::function<void(double)> progress() {
    return [this](double) { check(); };
  }
  /// Throws what the handler has thrown; with Python's lock.
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  bool in_main_thread_;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point next_;
  std::exception_ptr thrown_;
};

/// Does `work(watch)` with Python's lock released, so that other threads of Python run meanwhile.
template <class Work>
auto unlocked(Work&& work) {
  SignalWatch watch;
  try {
    auto result = [&] {
      const py::gil_scoped_release release;
      return work(watch);
    }();
    watch.rethrow();
    return result;
  } catch (const Interrupt&) {
    watch.rethrow();
    throw;
  }
}

/// How messages name the settings and the actions: "until=", "`.check()`".
const text::Vocabulary& python_words();

/// A text of any bytes; those that are not UTF-8 become replacement characters.
py::str to_str(std::string_view text);
/// Diagnostics as the tuples of which Python makes its own: file, line, column, what, expected, remedy,
/// message.
py::list to_list(const std::vector<text::Diagnostic>& diagnostics);
/// (name, unit) of each.
py::list to_list(const std::vector<text::TableColumn>& columns);

/// A table of numbers that moves into an array of NumPy, without a copy.
py::array_t<double> to_array(std::vector<double>&& values, std::size_t columns);
py::array_t<double> to_array(std::vector<double>&& values);

/// The entry of a dictionary; `otherwise` where there is none, or None.
template <class Value>
Value entry(const py::dict& dict, const char* name, Value otherwise) {
  if (!dict.contains(name) || dict[name].is_none()) return otherwise;
  return dict[name].cast<Value>();
}

/// gain, bandwidth, method, split, slower, derivatives, unit, period, force: those that are there.
patch::PatchOptions patch_options(const py::dict& options);
patch::PatchMethod patch_method(const std::string& name);

/// auto, light or dark.
draw::Theme theme_of(const std::string& name);

/// A mechanism and the text that it was read from.
struct MechanismModel {
  std::string text, file;
  mechanism::Mechanism mechanism;
};

// Each binds a part of the library.
void bind_errors(py::module_& module);
void bind_libraries(py::module_& module);
void bind_runs(py::module_& module);
void bind_diagrams(py::module_& module);
void bind_consoles(py::module_& module);
void bind_ensembles(py::module_& module);
void bind_mechanisms(py::module_& module);
void bind_patches(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model);
void bind_comparisons(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model);
void bind_pictures(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model);

}  // namespace oblique::python
