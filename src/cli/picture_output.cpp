// SPDX-License-Identifier: MIT
#include "picture_output.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include <fmt/format.h>

#include <oblique/text/document.h>

#include "terminal.h"

namespace oblique::cli {
namespace {

constexpr std::array<std::string_view, 2> kEndings{".svg", ".png"};

bool is_png(const std::string& path) {
  return std::filesystem::path(path).extension() == ".png";
}

/// A folder of our own for what goes between two programs.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code trouble;
    std::string name = (std::filesystem::temp_directory_path(trouble) / "oblique-XXXXXX").string();
    if (trouble || mkdtemp(name.data()) == nullptr) {
      throw ReadError(Diagnostic{{},
                                 "no temporary folder could be made for the conversion to pixels",
                                 {},
                                 "set TMPDIR to a folder that you may write to"});
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A word for the shell as it stands.
std::string quoted(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

bool converter_is_installed() {
  return std::system("command -v rsvg-convert >/dev/null 2>&1") == 0;
}

}  // namespace

void check_picture_output(const std::string& path) {
  check_output(path, kEndings);
  if (is_png(path)) require_converter(path);
}

void require_converter(const std::string& path) {
  if (converter_is_installed()) return;
  throw ReadError(Diagnostic{
      {path, {}},
      fmt::format("a {} is made by rsvg-convert, which is not installed", is_png(path) ? "PNG" : "GIF"),
      {},
      "install the Debian package librsvg2-bin, or write an .svg"});
}

std::string png_of(std::string_view svg, const std::string& path) {
  const ScratchFolder folder;
  const auto from = folder / "picture.svg", to = folder / "picture.png";
  write_file(from, svg);
  if (std::system(fmt::format("rsvg-convert {} -o {}", quoted(from), quoted(to)).c_str()) != 0) {
    throw ReadError(Diagnostic{{path, {}}, "rsvg-convert could not draw this", {}, "write an .svg"});
  }
  return read_file(to);
}

void save_picture(const Picture& picture, const std::string& path, Theme theme) {
  check_picture_output(path);
  const std::string svg = to_svg(picture, theme);
  save(path, is_png(path) ? png_of(svg, path) : svg);
}

Theme theme_option(const std::string& text) {
  if (text == "auto") return Theme::automatic;
  if (text == "light") return Theme::light;
  if (text == "dark") return Theme::dark;
  throw ReadError(Diagnostic{
      {}, fmt::format("--theme {}", text), "auto, light or dark", suggest(text, {"auto", "light", "dark"})});
}

}  // namespace oblique::cli
