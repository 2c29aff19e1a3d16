// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <oblique/report/atlas/atlas_site.h>
#include <oblique/report/run_text.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/picture_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

using std::filesystem::path;

/// Makes the folder of the site and sees that its pages can be written.
void claim_site(const path& site, const std::vector<path>& files) {
  std::error_code trouble;
  std::filesystem::create_directories(site, trouble);
  if (trouble)
    throw text::ReadError(text::Diagnostic{
        {site.string(), {}}, fmt::format("cannot make this folder: {}", trouble.message()), {}, {}});
  check_output(site / "index.html", ".html");
  for (const path& file : files) check_output(site / (file.stem().string() + ".html"), ".html");
}

/// Where the page of the studio is, as seen from the site.
std::string studio_from(const path& site, const std::string& studio) {
  if (studio.empty()) return {};
  std::error_code trouble;
  if (!std::filesystem::exists(studio, trouble))
    throw text::ReadError(text::Diagnostic{{studio, {}},
                                           "the page of the studio is not there",
                                           "build/web/studio.html",
                                           "build it with ./bootstrap web"});
  // The folder of the site may not be there yet: relative() takes such a path for one that leads nowhere.
  const path found =
      std::filesystem::relative(std::filesystem::absolute(studio), std::filesystem::absolute(site), trouble);
  return trouble || found.empty() ? std::filesystem::absolute(studio).string() : found.generic_string();
}

}  // namespace

ExitStatus run_atlas(const Session& session, const AtlasRequest& request) {
  if (request.output.empty() && !request.studio.empty())
    throw text::ReadError(text::Diagnostic{
        {}, "--studio is where pages lead to, and none are written", "-o SITE beside it", {}});
  const draw::Theme theme = theme_option(request.theme);
  const std::vector<path> files = report::programmes_in(request.folder);
  const std::string studio = studio_from(request.output, request.studio);
  if (!request.output.empty()) claim_site(request.output, files);
  const diagram::BlockLibrary library = session.blocks();
  std::vector<report::Programme> programmes;
  programmes.reserve(files.size());
  {
    Progress progress("running");
    for (const path& file : files) {
      programmes.push_back(report::run_programme(file, text::read_file(file), library));
      progress.show(static_cast<double>(programmes.size()) / static_cast<double>(files.size()));
    }
  }
  std::stable_partition(programmes.begin(), programmes.end(), [](const report::Programme& programme) {
    return programme.diagram.published->leads;
  });
  print(report::agreement_table(programmes).text(2));
  note(report::agreement_summary(programmes) + "\n");
  for (const report::Programme& programme : programmes) {
    const std::string warnings = report::warnings_text(programme.run, command_line()) +
                                 report::warnings_text(programme.results, command_line());
    if (!warnings.empty()) note(programme.name + ":\n" + warnings);
  }
  if (!request.output.empty()) {
    Progress progress("writing");
    const report::AtlasSite site{programmes,     library,
                                 theme,          studio,
                                 command_line(), [&](double fraction) { progress.show(fraction); }};
    std::vector<Written> written;
    for (const report::SitePage& page : site.pages())
      written.push_back({(path(request.output) / page.name).string(), page.text});
    save_together(written);
  }
  return report::all_known(programmes) ? ExitStatus::done : ExitStatus::no;
}

}  // namespace oblique::cli
