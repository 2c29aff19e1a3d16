// SPDX-License-Identifier: MIT
// The studio's page holds what it opens with as JSON in an element of its own, so the file of the caller
// takes the place of it; with the file go the blocks of --blocks and the recordings that it names.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/report/file_kind.h>
#include <oblique/text/document.h>
#include <oblique/text/file.h>

#include "terminal/output_files.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

using nlohmann::json;
using std::filesystem::path;

constexpr std::string_view kOpeningBegin = R"(<script type="application/json" id="opening">)";
constexpr std::string_view kElementEnd = "</script>";
constexpr std::size_t kMostText = 4U << 20U;  // what the page takes of one file

/// An environment's variable; empty where it is not set.
path variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? path() : path(value);
}

/// The page as it was built: the one that OBLIQUE_STUDIO names, else beside an installed program, else in the
/// build folder that the program is of.
path built_page() {
  if (path named = variable("OBLIQUE_STUDIO"); !named.empty()) return named;
  std::error_code trouble;
  const path program = std::filesystem::read_symlink("/proc/self/exe", trouble).parent_path();
  const std::array<path, 2> places{program / "../share/oblique/studio.html",
                                   program / "../../../web/studio.html"};
  const auto there = std::find_if(places.begin(), places.end(), [](const path& page) {
    std::error_code missing;
    return std::filesystem::exists(page, missing);
  });
  if (there != places.end()) return there->lexically_normal();
  throw text::ReadError(text::Diagnostic{{},
                                         "the page of the studio is not there",
                                         "build/web/studio.html of the folder that the program was built in, "
                                         "share/oblique/studio.html of the one "
                                         "it is installed in, or the page that OBLIQUE_STUDIO names",
                                         "build it with ./bootstrap web"});
}

std::string read_of_page_size(const path& file) {
  std::string text = text::read_file(file);
  if (text.size() > kMostText) {
    throw text::ReadError(text::Diagnostic{{file.string(), {}},
                                           fmt::format("the file has {} bytes", text.size()),
                                           fmt::format("at most {}, what the studio takes", kMostText),
                                           {}});
  }
  return text;
}

/// The files that a text names: what stands under the key `file` anywhere in it.
void collect_named(const text::Value& value, std::set<std::string>& names) {
  for (const text::Entry& entry : value.entries) {
    if (entry.key == "file" && entry.value.kind == text::Value::Kind::string) names.insert(entry.value.text);
    collect_named(entry.value, names);
  }
  for (const text::Value& element : value.elements) collect_named(element, names);
}

/// What the page opens with: {"name", "text", "files", "blocks"}.
json opening_of(const Session& session, const path& file) {
  const std::string text = read_of_page_size(file);
  report::kind_of_file(text, file.string());  // refuses what is neither
  json opening{{"name", file.filename().string()},
               {"text", text},
               {"files", json::array()},
               {"blocks", json::array()}};
  std::set<std::string> named;
  collect_named(text::parse_document(text, file.string()).root, named);
  for (const std::string& name : named)
    opening["files"].push_back({{"name", name}, {"text", read_of_page_size(file.parent_path() / name)}});
  for (const path& folder : session.block_directories) {
    std::vector<path> blocks;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".toml") blocks.push_back(entry.path());
    std::sort(blocks.begin(), blocks.end());
    for (const path& block : blocks)
      opening["blocks"].push_back({{"name", block.stem().string()}, {"text", read_of_page_size(block)}});
  }
  return opening;
}

/// The page with this in the place of what it opens with.
std::string with_opening(std::string page, const json& opening, const path& file) {
  const std::size_t begin = page.find(kOpeningBegin);
  const std::size_t end = begin == std::string::npos ? begin : page.find(kElementEnd, begin);
  if (end == std::string::npos) {
    throw text::ReadError(text::Diagnostic{{file.string(), {}},
                                           "this is no page of the studio",
                                           "what ./bootstrap web builds",
                                           "build it again, or unset OBLIQUE_STUDIO"});
  }
  std::string inside;
  for (const char c : opening.dump()) inside += c == '<' ? std::string("\\u003c") : std::string(1, c);
  const std::size_t from = begin + kOpeningBegin.size();
  return page.replace(from, end - from, inside);
}

/// A place of its own for a page that nobody wants to keep.
path place_in_cache(const path& file) {
  path cache = variable("XDG_CACHE_HOME");
  if (const path home = variable("HOME"); cache.empty() && !home.empty()) cache = home / ".cache";
  if (cache.empty())
    throw text::ReadError(text::Diagnostic{{}, "there is no place for the page", "-o PAGE.html", {}});
  const path folder = cache / "oblique" / "studio";
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  return folder / (file.empty() ? "studio.html" : file.stem().string() + ".html");
}

/// Whether a browser was asked to open it: by the desktop's own program, where there is a desktop.
bool open_in_browser(const path& page) {
  if (variable("DISPLAY").empty() && variable("WAYLAND_DISPLAY").empty()) return false;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_WRONLY, 0);
  std::string program = "xdg-open";
  std::string given = std::filesystem::absolute(page).string();
  std::array<char*, 3> arguments{program.data(), given.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  return failed == 0;
}

}  // namespace

ExitStatus write_studio(const Session& session, const StudioRequest& request) {
  const path built = built_page();
  const path output = request.output.empty() ? place_in_cache(request.file) : path(request.output);
  check_output(output, ".html");
  std::string page = text::read_file(built);
  if (!request.file.empty())
    page = with_opening(std::move(page), opening_of(session, request.file), built);
  else if (!session.block_directories.empty())
    throw text::ReadError(
        text::Diagnostic{{}, "--blocks goes with a FILE that uses them", {}, "leave it out"});
  save(output, page);
  if (!request.stay && !open_in_browser(output))
    note("there is no desktop to open it on: open it in a browser");
  return ExitStatus::done;
}

}  // namespace oblique::cli
