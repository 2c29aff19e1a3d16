// SPDX-License-Identifier: MIT
#include "binding.h"

#include <algorithm>

#include <fmt/format.h>

namespace oblique::python {

SignalWatch::SignalWatch()
    : in_main_thread_(
          py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>() ==
          PyThread_get_thread_ident()),
      next_(std::chrono::steady_clock::now()) {}

bool SignalWatch::asked() {
  if (thrown_) return true;
  if (!in_main_thread_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + std::chrono::milliseconds(50);
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() == 0) return false;
  try {
    throw py::error_already_set();
  } catch (...) {
    thrown_ = std::current_exception();
  }
  return true;
}

const text::Vocabulary& python_words() {
  static const text::Vocabulary words{
      [](const text::Setting& setting) {
        if (setting.name == "rescale") return std::string("`.rescaled()`");
        std::string name = setting.name == "from" ? "state" : setting.name;  // `from` is a word of Python's
        std::replace(name.begin(), name.end(), '-', '_');
        const std::string& value = setting.value;
        if (value.empty()) return name + "=";
        if (name == "split") {
          std::string list;
          for (const char c : value) list += c == ',' ? std::string("\", \"") : std::string(1, c);
          return fmt::format("{}=[\"{}\"]", name, list);
        }
        const auto spelled = [](const std::string& text) {
          const bool is_number =
              !text.empty() && text.find_first_not_of("0123456789.e+-") == std::string::npos;
          return is_number || text == "True" ? text : "\"" + text + "\"";
        };
        if (const std::size_t equals = value.find('='); name == "set" && equals != std::string::npos)
          return fmt::format("set={{\"{}\": {}}}", value.substr(0, equals),
                             spelled(value.substr(equals + 1)));
        return fmt::format("{}={}", name, spelled(value));
      },
      [](const text::Action& action) {
        if (action.name == "ensemble run") return std::string("`oblique.Plan`");
        return action.name == "machines" ? std::string("`oblique.machines`")
                                         : fmt::format("`.{}()`", action.name);
      }};
  return words;
}

py::str to_str(std::string_view text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

py::list to_list(const std::vector<text::Diagnostic>& diagnostics) {
  py::list list;
  for (const text::Diagnostic& found : diagnostics) {
    const text::SourcePosition& at = found.place.position;
    list.append(py::make_tuple(to_str(found.place.file), at.line, at.column, to_str(found.what),
                               to_str(found.expected), to_str(found.remedy.words(python_words())),
                               to_str(text::to_string(found, python_words()))));
  }
  return list;
}

py::list to_list(const std::vector<text::TableColumn>& columns) {
  py::list list;
  for (const text::TableColumn& column : columns)
    list.append(py::make_tuple(to_str(column.name), to_str(column.unit)));
  return list;
}

py::array_t<double> to_array(std::vector<double>&& values, std::size_t columns) {
  auto owned = std::make_unique<std::vector<double>>(std::move(values));
  const double* const data = owned->data();
  const std::size_t rows = columns == 0 ? 0 : owned->size() / columns;
  const py::capsule owner(owned.release(),
                          [](void* kept) { delete static_cast<std::vector<double>*>(kept); });
  return py::array_t<double>({rows, columns}, data, owner);
}

py::array_t<double> to_array(std::vector<double>&& values) {
  const std::size_t n = values.size();
  return to_array(std::move(values), 1).reshape({n});
}

patch::PatchMethod patch_method(const std::string& name) {
  if (const auto method = patch::parse_patch_method(name)) return *method;
  throw text::ReadError(text::Diagnostic{{},
                                         fmt::format("method=\"{}\" is no method of patching", name),
                                         "triangles, gradient or paper",
                                         text::suggest(name, {"triangles", "gradient", "paper"})});
}

draw::Theme theme_of(const std::string& name) {
  if (name == "auto") return draw::Theme::automatic;
  if (name == "light") return draw::Theme::light;
  if (name == "dark") return draw::Theme::dark;
  throw text::ReadError(text::Diagnostic{{},
                                         fmt::format("theme=\"{}\" is no theme", name),
                                         "auto, light or dark",
                                         text::suggest(name, {"auto", "light", "dark"})});
}

patch::PatchOptions patch_options(const py::dict& options) {
  patch::PatchOptions patch;
  patch.method = patch_method(entry<std::string>(options, "method", "triangles"));
  patch.gain = entry(options, "gain", patch.gain);
  patch.bandwidth = entry(options, "bandwidth", patch.bandwidth);
  patch.derivatives = entry(options, "derivatives", false);
  patch.split = entry(options, "split", patch.split);
  patch.slower = entry(options, "slower", patch.slower);
  patch.unit = entry(options, "unit", patch.unit);
  patch.period = entry(options, "period", patch.period);
  patch.force = entry(options, "force", false);
  return patch;
}

}  // namespace oblique::python
