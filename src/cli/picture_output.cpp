// SPDX-License-Identifier: MIT
#include "picture_output.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <oblique/draw/svg.h>
#include <oblique/text/diagnostic.h>
#include <oblique/text/document.h>

#include "terminal.h"

namespace oblique::cli {
namespace {

constexpr const char* kPainter = "rsvg-convert";

/// The painter's file in the search path, or nothing.
std::filesystem::path painter() {
  const char* const search_path = std::getenv("PATH");
  std::string_view rest = search_path == nullptr ? "" : search_path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::filesystem::path file = std::filesystem::path(rest.substr(0, end)) / kPainter;
    if (access(file.c_str(), X_OK) == 0) return file;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

bool is_png(const std::filesystem::path& path) {
  return path.extension() == ".png";
}

/// A folder of our own among the temporary files, gone with this.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "oblique-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw ReadError(
          Diagnostic{{name, {}}, "no folder for temporary files could be made", {}, "set TMPDIR"});
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code gone;
    std::filesystem::remove_all(path_, gone);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string painted(const std::string& svg, const std::string& path) {
  const TemporaryFolder folder;
  const std::string source = folder.file("picture.svg"), target = folder.file("picture.png");
  write_file(source, svg);
  const std::string program = painter();
  const pid_t child = fork();
  if (child == 0) {
    execl(program.c_str(), kPainter, "--zoom=2", "--output", target.c_str(), source.c_str(), nullptr);
    _exit(127);
  }
  int status = -1;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw ReadError(
        Diagnostic{{path, {}}, fmt::format("{} could not paint this picture", kPainter), {}, "write .svg"});
  }
  return read_file(target);
}

}  // namespace

void check_picture_output(const std::string& path) {
  check_output(path, kPictureEndings);
  if (!is_png(path) || !painter().empty()) return;
  throw ReadError(Diagnostic{{path, {}},
                             fmt::format(".png is painted by {}, which is not installed", kPainter),
                             {},
                             "install the package librsvg2-bin, or write .svg"});
}

void save_picture(const Picture& picture, const std::string& path) {
  check_picture_output(path);
  save(path, is_png(path) ? painted(to_svg(picture, Theme::light), path) : to_svg(picture));
}

}  // namespace oblique::cli
