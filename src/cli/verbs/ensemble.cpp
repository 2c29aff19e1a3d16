// SPDX-License-Identifier: MIT
// An ensemble from its plan: chunks of it, what there is of them, the table of all.
#include <algorithm>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/ensemble/plan/gather.h>
#include <oblique/report/study/study_text.h>
#include <oblique/report/text_table.h>
#include <oblique/text/file.h>

#include "terminal/output_files.h"
#include "terminal/signals.h"
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/job_script.h"

namespace oblique::cli {
namespace {

/// Thrown out of the work where Ctrl-C asks for its end.
struct Interrupted {};

/// A plan with its subject, ready to run.
struct Opened {
  ensemble::PlanFile file;
  diagram::BlockLibrary library;
  ensemble::Study study;
  ensemble::ChunkWork work;

  Opened(const Session& session, const EnsembleRequest& request, ensemble::PlanFile read,
         const std::string& text)
      : file(std::move(read)),
        library(session.blocks()),
        study(file.plan, text, library, threads(request.jobs)) {
    work = ensemble::work_of(
        study, ensemble::identity_of(file.plan, text, session.block_directories, OBLIQUE_VERSION));
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  static int threads(int jobs) {
    return jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  }
};

Opened open_plan(const Session& session, const EnsembleRequest& request) {
  ensemble::PlanFile file = ensemble::read_plan(request.plan);
  if (!file.version.empty() && file.version != OBLIQUE_VERSION) {
    note(fmt::format(
        "warning: {}: the plan was written by version {} of the program, this is {}: the numbers may differ "
        "from those it was made for\n  remedy: run it with that version, or set 'version' in it to \"{}\"\n",
        request.plan, file.version, OBLIQUE_VERSION, OBLIQUE_VERSION));
  }
  const std::string text = text::read_file(file.plan.subject);
  return Opened(session, request, std::move(file), text);
}

/// "10000 machines: 9990 in lanes, 10 by CVODES (10 an event); 2 failed: …"
std::string count_text(const ensemble::EnsembleCount& count) {
  std::string text = fmt::format("{}: {} in lanes, {} by CVODES",
                                 report::count(count.in_lanes + count.by_cvodes, "machine", "machines"),
                                 count.in_lanes, count.by_cvodes);
  std::vector<std::string> reasons;
  for (const auto& [reason, times] : count.reasons) reasons.push_back(fmt::format("{} {}", times, reason));
  if (!reasons.empty()) text += fmt::format(" ({})", fmt::join(reasons, ", "));
  if (count.first_warned) {
    text += fmt::format("\nwarning of {}; the first, machine {}: {}",
                        report::count(count.warned, "machine", "machines"), count.first_warned->first,
                        count.first_warned->second);
  }
  return text + "\n" + report::coarse_text(count);
}

void warn_of(const std::vector<std::pair<std::uint64_t, std::string>>& failures) {
  constexpr std::size_t kShown = 3;
  if (failures.empty()) return;
  std::string text = fmt::format("warning: {} failed, and {} no measures:\n",
                                 report::count(failures.size(), "machine", "machines"),
                                 failures.size() == 1 ? "has" : "have");
  for (std::size_t k = 0; k < std::min(kShown, failures.size()); ++k)
    text += fmt::format("  machine {}: {}\n", failures[k].first, failures[k].second);
  if (failures.size() > kShown) text += fmt::format("  … and {} more\n", failures.size() - kShown);
  note(text);
}

/// How to make what is missing.
std::string run_command(const EnsembleRequest& request, const ensemble::Gathering& gathering) {
  const std::string way =
      gathering.chunks > 0 ? fmt::format(" --chunks {}", gathering.chunks) : std::string();
  return fmt::format("`oblique ensemble run {}{} -o {}`", request.plan, way, request.folder);
}

/// Says what is missing and what is damaged.
void tell_missing(const EnsembleRequest& request, const ensemble::Gathering& gathering) {
  constexpr std::size_t kShown = 10;
  for (std::size_t k = 0; k < std::min(kShown, gathering.damaged.size()); ++k) {
    const ensemble::Gathering::Damaged& one = gathering.damaged[k];
    print_error(
        one.is_ours
            ? fmt::format("{}: this chunk counts as missing: {}\n  remedy: run it again, which replaces it",
                          one.file.string(), one.trouble)
            : fmt::format("{}: this is no chunk of the plan, and is left out: {}\n  remedy: delete it",
                          one.file.string(), one.trouble));
  }
  if (gathering.damaged.size() > kShown)
    print_error(fmt::format("{}: {} more are damaged (`oblique ensemble status` lists them)", request.folder,
                            gathering.damaged.size() - kShown));
  if (gathering.chunks == 0) {
    print_error(fmt::format("{}: there is no chunk of {} here\n  remedy: {} makes them", request.folder,
                            request.plan, run_command(request, gathering)));
    return;
  }
  constexpr std::size_t kNamed = 100;
  std::vector<std::string> names;
  for (const ensemble::ChunkPlace& place : gathering.missing) {
    if (names.size() < kNamed) names.push_back(ensemble::name_of(place));
  }
  std::string text = fmt::format("{}: {} of {} {} missing: {}", request.folder, gathering.missing.size(),
                                 report::count(gathering.chunks, "chunk", "chunks"),
                                 gathering.missing.size() == 1 ? "is" : "are", fmt::join(names, ", "));
  if (names.size() < gathering.missing.size())
    text += fmt::format(" … and {} more (`oblique ensemble status` lists them)",
                        gathering.missing.size() - names.size());
  print_error(text + fmt::format("\n  remedy: {} makes what is missing", run_command(request, gathering)));
}

ExitStatus write_gathered(const EnsembleRequest& request, const ensemble::ChunkWork& work) {
  const ensemble::Gathering gathering =
      ensemble::look_through(request.folder, work.identity, work.runs, work.columns.size());
  if (!gathering.complete()) {
    tell_missing(request, gathering);
    return ExitStatus::no;
  }
  ensemble::write_table(gathering, work.columns, request.table);
  note(fmt::format("wrote {}\n", request.table));
  note(count_text(gathering.count()));
  warn_of(gathering.failures());
  return ExitStatus::done;
}

std::vector<ensemble::ChunkPlace> places_of(const EnsembleRequest& request, std::uint64_t runs) {
  if (!request.chunk.empty()) return {ensemble::parse_chunk_place(request.chunk, runs)};
  const std::uint64_t chunks =
      request.chunks ? static_cast<std::uint64_t>(*request.chunks) : ensemble::usual_chunks(runs);
  std::vector<ensemble::ChunkPlace> places{ensemble::chunk_place(0, chunks, runs)};
  for (std::uint64_t k = 1; k < chunks; ++k) places.push_back(ensemble::chunk_place(k, chunks, runs));
  return places;
}

[[noreturn]] void refuse_ensemble(const std::string& what, const std::string& expected) {
  throw text::ReadError(text::Diagnostic{{}, what, expected, {}});
}

}  // namespace

ExitStatus run_ensemble(const Session& session, const EnsembleRequest& request) {
  if (!request.chunk.empty() && request.chunks)
    refuse_ensemble("--chunk makes one chunk and --chunks all", "one of the two");
  if (!request.chunk.empty() && !request.table.empty())
    refuse_ensemble("--table is for all chunks, and --chunk makes one", "one of the two");
  if (!request.table.empty()) check_table_output(request.table, {});
  const Opened plan = open_plan(session, request);
  const std::vector<ensemble::ChunkPlace> places = places_of(request, plan.work.runs);
  ensemble::make_folder(request.folder);
  // What does not belong there is known before the work, not after it.
  if (!request.table.empty())
    ensemble::look_through(request.folder, plan.work.identity, plan.work.runs, plan.work.columns.size());
  std::uint64_t all = 0, before = 0, made = 0;
  for (const ensemble::ChunkPlace& place : places) all += place.count;
  bool interrupted = false;
  try {
    const InterruptGuard guard;
    Progress progress("running");
    for (const ensemble::ChunkPlace& place : places) {
      if (InterruptGuard::asked()) throw Interrupted();
      const bool new_one = ensemble::make_chunk(request.folder, plan.work, place, [&](std::uint64_t done) {
        if (InterruptGuard::asked()) throw Interrupted();
        progress.show(static_cast<double>(before + done) / static_cast<double>(all));
      });
      before += place.count;
      made += new_one ? 1 : 0;
    }
  } catch (const Interrupted&) {
    interrupted = true;
  } catch (...) {
    if (made > 0)
      note(fmt::format("{} made in {} before that; the same command goes on with what is missing\n",
                       report::count(made, "chunk was", "chunks were"), request.folder));
    throw;
  }
  note(fmt::format("{} made in {}, {} there already\n", report::count(made, "chunk", "chunks"),
                   request.folder, places.size() - made));
  if (interrupted) {
    note("interrupted: the same command goes on with what is missing\n");
    std::raise(SIGINT);
  }
  return request.table.empty() ? ExitStatus::done : write_gathered(request, plan.work);
}

ExitStatus gather_ensemble(const Session& session, const EnsembleRequest& request) {
  check_table_output(request.table, {});
  const Opened plan = open_plan(session, request);
  return write_gathered(request, plan.work);
}

ExitStatus show_ensemble(const Session& session, const EnsembleRequest& request) {
  const Opened plan = open_plan(session, request);
  const ensemble::Gathering gathering =
      ensemble::look_through(request.folder, plan.work.identity, plan.work.runs, plan.work.columns.size());
  print(fmt::format("{} of {} are there, in {}\n", gathering.runs_there,
                    report::count(plan.work.runs, "run", "runs"),
                    report::count(gathering.parts.size(), "chunk", "chunks")));
  for (const ensemble::ChunkPlace& place : gathering.missing)
    print(fmt::format("missing: {} (machines {} to {})\n", ensemble::name_of(place), place.first,
                      place.first + place.count - 1));
  for (const ensemble::Gathering::Damaged& one : gathering.damaged)
    print(fmt::format("{}: {}: {}\n", one.is_ours ? "damaged" : "no chunk of the plan", one.file.string(),
                      one.trouble));
  return gathering.complete() ? ExitStatus::done : ExitStatus::no;
}

ExitStatus script_ensemble(const Session& session, const EnsembleRequest& request) {
  if (!request.slurm) refuse_ensemble("nothing says which kind of script is wanted", "--slurm");
  if (!request.output.empty()) check_output(request.output, ".sh");
  const Opened plan = open_plan(session, request);
  JobScript job;
  std::error_code error;
  job.program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) job.program = "oblique";
  for (const std::filesystem::path& folder : session.block_directories)
    job.blocks.push_back(std::filesystem::absolute(folder));
  job.plan = std::filesystem::absolute(request.plan).lexically_normal();
  job.folder = std::filesystem::absolute(
                   request.folder.empty() ? std::filesystem::path(request.plan).replace_extension(".chunks")
                                          : std::filesystem::path(request.folder))
                   .lexically_normal();
  job.name = job.plan.stem().string();
  job.chunks =
      request.chunks
          ? ensemble::chunk_place(0, static_cast<std::uint64_t>(*request.chunks), plan.work.runs).chunks
          : ensemble::usual_chunks(plan.work.runs);
  job.threads = std::max(1, request.jobs);
  job.time = request.time;
  job.memory = request.memory;
  const std::string script = slurm_script(job);
  // Slurm writes the logs there from the start of a job on.
  ensemble::make_folder(job.folder);
  if (job.chunks > kLongestArray)
    note(fmt::format(
        "warning: {} jobs: Slurm takes arrays of up to {} unless its MaxArraySize says otherwise\n"
        "  remedy: --chunks {} or fewer, or ask who keeps the cluster\n",
        job.chunks, kLongestArray, kLongestArray));
  if (request.output.empty()) {
    print(script);
  } else {
    save(request.output, script);
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
