// SPDX-License-Identifier: MIT
#include "terminal/picture_output.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

#include <fmt/format.h>

#include <oblique/text/file.h>
#include <oblique/text/leftover.h>
#include <oblique/text/new_file.h>

#include "terminal/output_files.h"
#include "terminal/signals.h"
#include "terminal/terminal.h"

namespace oblique::cli {
namespace {

constexpr std::array<std::string_view, 2> kEndings{".svg", ".png"};

bool is_png(const std::string& path) {
  return std::filesystem::path(path).extension() == ".png";
}

[[noreturn]] void fail_without_folder() {
  throw text::ReadError(text::Diagnostic{{},
                                         "no temporary folder could be made for the conversion to pixels",
                                         {},
                                         "set TMPDIR to a folder that you may write to"});
}

std::string folder_pattern() {
  std::error_code trouble;
  std::string pattern = (std::filesystem::temp_directory_path(trouble) / "oblique-XXXXXX").string();
  if (trouble) fail_without_folder();
  return pattern;
}

/// A folder of our own for what goes between two programs. Once it is there nothing takes memory: where that
/// runs out the folder is cleared away too.
class ScratchFolder {
 public:
  ScratchFolder() : name_(folder_pattern()), svg_(name_ + "/picture.svg"), png_(name_ + "/picture.png") {
    if (mkdtemp(name_.data()) == nullptr) fail_without_folder();
    name_.copy(svg_.data(), name_.size());
    name_.copy(png_.data(), name_.size());
    leftovers_[0].remember(name_);
    leftovers_[1].remember(svg_);
    leftovers_[2].remember(png_);
  }
  ~ScratchFolder() {
    unlink(svg_.c_str());
    unlink(png_.c_str());
    rmdir(name_.c_str());
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& svg() const { return svg_; }
  const std::string& png() const { return png_; }

 private:
  std::string name_, svg_, png_;
  std::array<text::Leftover, 3> leftovers_;  ///< for signals
};

/// A word for the shell as it stands.
std::string quoted(const std::string& path) {
  std::string text = "'";
  for (const char c : path) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Whether a command for the shell ends well. `path` is what it is for.
bool succeeds(const std::string& command, const std::string& path) {
  const int status = std::system(command.c_str());
  if (status < 0) {
    throw text::ReadError(
        text::Diagnostic{{path, {}},
                         fmt::format("rsvg-convert could not be started: {}", std::strerror(errno)),
                         {},
                         "end other programs, or write an .svg"});
  }
  end_as_ended(status);
  return status == 0;
}

}  // namespace

void check_picture_output(const std::string& path) {
  check_output(path, kEndings);
  if (is_png(path)) require_converter(path);
}

void require_converter(const std::string& path) {
  if (succeeds("command -v rsvg-convert >/dev/null 2>&1", path)) return;
  throw text::ReadError(text::Diagnostic{
      {path, {}},
      fmt::format("a {} is made by rsvg-convert, which is not installed", is_png(path) ? "PNG" : "GIF"),
      {},
      "install the Debian package librsvg2-bin, or write an .svg"});
}

std::string png_of(std::string_view svg, const std::string& path) {
  const ScratchFolder folder;
  text::NewFile file(folder.svg());
  file.append(svg);
  file.commit(text::NewFile::Lasting::no);
  if (!succeeds(fmt::format("rsvg-convert {} -o {}", quoted(folder.svg()), quoted(folder.png())), path)) {
    throw text::ReadError(
        text::Diagnostic{{path, {}}, "rsvg-convert could not draw this", {}, "write an .svg"});
  }
  return text::read_file(folder.png());
}

void save_picture(const draw::Picture& picture, const std::string& path, draw::Theme theme) {
  const std::string svg = draw::to_svg(picture, theme);
  save(path, is_png(path) ? png_of(svg, path) : svg);
}

draw::Theme theme_option(const std::string& text) {
  if (text == "auto") return draw::Theme::automatic;
  if (text == "light") return draw::Theme::light;
  if (text == "dark") return draw::Theme::dark;
  throw text::ReadError(text::Diagnostic{{},
                                         fmt::format("--theme {}", text),
                                         "auto, light or dark",
                                         text::suggest(text, {"auto", "light", "dark"})});
}

}  // namespace oblique::cli
