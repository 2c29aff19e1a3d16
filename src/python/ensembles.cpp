// SPDX-License-Identifier: MIT
#include "binding.h"

#include <chrono>
#include <optional>

#include <fmt/format.h>

#include <oblique/ensemble/plan/gather.h>
#include <oblique/text/file.h>

namespace oblique::python {
namespace {

/// A plan with its subject, ready to run. Nothing in it changes, so threads share it.
struct PlanModel {
  Library library;
  ensemble::PlanFile file;
  std::string subject;
  std::unique_ptr<const ensemble::Study> study;
  ensemble::ChunkWork work;
};

/// `subject` is the text of the subject; without it its file is read.
std::shared_ptr<PlanModel> open_plan(const std::string& text, const std::string& file,
                                     std::optional<std::string> subject, const Library& library,
                                     const std::vector<std::string>& folders, int threads) {
  return unlocked([&](SignalWatch&) {
    auto plan = std::make_shared<PlanModel>();
    plan->library = library;
    plan->file = ensemble::parse_plan(text, file);
    plan->subject = subject ? std::move(*subject) : text::read_file(plan->file.plan.subject);
    plan->study = std::make_unique<const ensemble::Study>(plan->file.plan, plan->subject, *library, threads);
    const std::vector<std::filesystem::path> paths(folders.begin(), folders.end());
    plan->work = ensemble::work_of(
        *plan->study, ensemble::identity_of(plan->file.plan, plan->subject, paths, OBLIQUE_VERSION));
    return plan;
  });
}

/// What the numbers depend on, each part as a fingerprint.
py::tuple identity(const PlanModel& plan) {
  const ensemble::Identity& all = plan.work.identity;
  return py::make_tuple(all.version, all.plan, all.subject, all.blocks);
}

py::dict count_of(const ensemble::EnsembleCount& count) {
  py::dict dict;
  dict["in_lanes"] = count.in_lanes;
  dict["by_cvodes"] = count.by_cvodes;
  dict["failed"] = count.failed;
  dict["warned"] = count.warned;
  py::dict reasons;
  for (const auto& [reason, times] : count.reasons) reasons[to_str(reason)] = times;
  dict["reasons"] = reasons;
  return dict;
}

py::list failures_of(const std::vector<std::pair<std::uint64_t, std::string>>& failures) {
  py::list list;
  for (const auto& [number, why] : failures) list.append(py::make_tuple(number, to_str(why)));
  return list;
}

/// (rows, failures, count) of a chunk.
py::tuple contents_of(ensemble::Chunk&& chunk, std::size_t columns) {
  const py::list failures = failures_of(chunk.head.failures);
  return py::make_tuple(to_array(std::move(chunk.rows), columns), failures, count_of(chunk.head.count));
}

/// Lets the making of a chunk end for Ctrl-C, and where it takes longer than so many seconds.
ensemble::Ensemble::Progress watching(SignalWatch& watch, std::optional<double> seconds = {}) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  return [&watch, seconds, begin](std::uint64_t) {
    watch.check();
    if (seconds && std::chrono::duration<double>(Clock::now() - begin).count() > *seconds)
      throw ensemble::PlanError(
          text::Diagnostic{{},
                           fmt::format("it took longer than {:g} s", *seconds),
                           {},
                           text::Remedy{"cut the ensemble into more ", text::Setting{"chunks"},
                                        ", or allow a longer ", text::Setting{"time_limit"}}});
  };
}

/// Runs all machines, or those that are done when a signal comes or `progress` throws: (rows, failures,
/// count, numbers of the machines, what was thrown).
py::tuple run(const PlanModel& plan, const py::object& progress) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kBetweenTwo = std::chrono::milliseconds(200);
  SignalWatch watch;
  std::exception_ptr thrown;
  Clock::time_point next = Clock::now() + kBetweenTwo;
  const std::uint64_t runs = plan.work.runs;
  const auto tell = [&](std::uint64_t done) {
    if (thrown || Clock::now() < next) return;
    const py::gil_scoped_acquire lock;
    try {
      progress(done, runs);
    } catch (...) {
      thrown = std::current_exception();
    }
    next = Clock::now() + kBetweenTwo;
  };
  ensemble::Study::Rows found;
  {
    const py::gil_scoped_release release;
    found = plan.study->run(0, runs, progress.is_none() ? ensemble::Ensemble::Progress() : tell,
                            [&] { return thrown || watch.asked(); });
  }
  py::object stop = py::none();
  try {
    watch.rethrow();
    if (thrown) std::rethrow_exception(thrown);
  } catch (const py::error_already_set& error) {
    stop = error.value();
  }
  thrown = nullptr;
  std::vector<double> rows;
  rows.reserve(found.rows.size() * plan.work.columns.size());
  std::vector<std::pair<std::uint64_t, std::string>> failures;
  py::array_t<std::int64_t> numbers(static_cast<py::ssize_t>(found.rows.size()));
  std::int64_t* number = numbers.mutable_data();
  for (ensemble::StudyRow& row : found.rows) {
    *number++ = static_cast<std::int64_t>(row.number);
    rows.insert(rows.end(), row.values.begin(), row.values.end());
    if (!row.failure.empty()) failures.emplace_back(row.number, std::move(row.failure));
  }
  return py::make_tuple(to_array(std::move(rows), plan.work.columns.size()), failures_of(failures),
                        count_of(found.count), numbers, stop);
}

ensemble::ChunkPlace place_of(const PlanModel& plan, std::uint64_t number, std::uint64_t chunks) {
  return ensemble::chunk_place(number, chunks, plan.work.runs);
}

py::bytes chunk_bytes(const PlanModel& plan, std::uint64_t number, std::uint64_t chunks,
                      std::optional<double> seconds) {
  const ensemble::ChunkPlace place = place_of(plan, number, chunks);
  return unlocked([&](SignalWatch& watch) {
    return ensemble::to_bytes(ensemble::run_chunk(plan.work, place, watching(watch, seconds)));
  });
}

bool make_chunk(const PlanModel& plan, std::uint64_t number, std::uint64_t chunks,
                const std::string& folder) {
  const ensemble::ChunkPlace place = place_of(plan, number, chunks);
  return unlocked([&](SignalWatch& watch) {
    ensemble::make_folder(folder);
    return ensemble::make_chunk(folder, plan.work, place, watching(watch));
  });
}

/// A chunk of its bytes. Throws where they are not just this one.
ensemble::Chunk read_chunk(const PlanModel& plan, std::uint64_t number, std::uint64_t chunks,
                           const std::string& bytes) {
  const ensemble::ChunkPlace place = place_of(plan, number, chunks);
  ensemble::ReadChunk read = ensemble::parse_chunk(bytes);
  if (read.chunk &&
      (read.chunk->head.identity != plan.work.identity || read.chunk->head.place.first != place.first ||
       read.chunk->head.place.count != place.count))
    read = {{}, "it is another one"};
  if (!read.chunk)
    throw ensemble::PlanError(text::Diagnostic{
        {}, fmt::format("chunk {} cannot be taken: {}", ensemble::name_of(place), read.trouble), {}, {}});
  return std::move(*read.chunk);
}

ensemble::Gathering look(const PlanModel& plan, const std::string& folder) {
  return ensemble::look_through(folder, plan.work.identity, plan.work.runs, plan.work.columns.size());
}

/// (number, chunks, first, count) of each chunk that is missing, (file, trouble) of each that is damaged, the
/// runs that are there.
py::tuple status(const PlanModel& plan, const std::string& folder) {
  const ensemble::Gathering found = unlocked([&](SignalWatch&) { return look(plan, folder); });
  py::list missing, damaged;
  for (const ensemble::ChunkPlace& place : found.missing)
    missing.append(py::make_tuple(place.number, place.chunks, place.first, place.count));
  for (const ensemble::Gathering::Damaged& one : found.damaged)
    damaged.append(py::make_tuple(to_str(one.file.string()), to_str(one.trouble)));
  return py::make_tuple(missing, damaged, found.runs_there, found.complete());
}

/// (rows, failures, count) of all, which are all there; with `table` they are written too.
py::tuple gather(const PlanModel& plan, const std::string& folder, const std::string& table) {
  ensemble::Gathering found;
  std::vector<double> rows = unlocked([&](SignalWatch&) {
    found = look(plan, folder);
    if (!table.empty()) ensemble::write_table(found, plan.work.columns, table);
    return ensemble::rows_of(found, plan.work.columns.size());
  });
  return py::make_tuple(to_array(std::move(rows), plan.work.columns.size()), failures_of(found.failures()),
                        count_of(found.count()));
}

}  // namespace

void bind_ensembles(py::module_& module) {
  py::class_<PlanModel, std::shared_ptr<PlanModel>>(module, "Plan")
      .def(py::init(&open_plan))
      .def_property_readonly("title", [](const PlanModel& plan) { return to_str(plan.file.title); })
      .def_property_readonly("version", [](const PlanModel& plan) { return to_str(plan.file.version); })
      .def_property_readonly("seed", [](const PlanModel& plan) { return plan.file.plan.seed; })
      .def_property_readonly("subject", [](const PlanModel& plan) { return py::bytes(plan.subject); })
      .def_property_readonly("runs", [](const PlanModel& plan) { return plan.work.runs; })
      .def_property_readonly("columns", [](const PlanModel& plan) { return to_list(plan.work.columns); })
      .def_property_readonly("n_varied", [](const PlanModel& plan) { return plan.study->n_varied(); })
      .def_property_readonly("identity", &identity)
      .def("toml", [](const PlanModel& plan,
                      const std::string& file) { return to_str(ensemble::write_plan(plan.file, file)); })
      .def("usual_chunks", [](const PlanModel& plan) { return ensemble::usual_chunks(plan.work.runs); })
      .def("check_chunks", [](const PlanModel& plan, std::uint64_t chunks) { place_of(plan, 0, chunks); })
      .def("first_run", [](const PlanModel& plan, std::uint64_t number,
                           std::uint64_t chunks) { return place_of(plan, number, chunks).first; })
      .def("file_name",
           [](const PlanModel& plan, std::uint64_t number, std::uint64_t chunks) {
             return ensemble::file_name_of(plan.work.identity, place_of(plan, number, chunks));
           })
      .def("is_done",
           [](const PlanModel& plan, std::uint64_t number, std::uint64_t chunks, const std::string& folder) {
             const ensemble::ChunkPlace place = place_of(plan, number, chunks);
             return ensemble::is_done(
                 std::filesystem::path(folder) / ensemble::file_name_of(plan.work.identity, place), plan.work,
                 place);
           })
      .def("run", &run)
      .def("chunk_bytes", &chunk_bytes)
      .def("make_chunk", &make_chunk)
      .def("read_chunk",
           [](const PlanModel& plan, std::uint64_t number, std::uint64_t chunks, const std::string& bytes) {
             return contents_of(read_chunk(plan, number, chunks, bytes), plan.work.columns.size());
           })
      .def("store",
           [](const PlanModel& plan, std::uint64_t number, std::uint64_t chunks, const std::string& bytes,
              const std::string& folder) {
             read_chunk(plan, number, chunks, bytes);
             ensemble::make_folder(folder);
             text::write_file(std::filesystem::path(folder) /
                                  ensemble::file_name_of(plan.work.identity, place_of(plan, number, chunks)),
                              bytes);
           })
      .def("status", &status)
      .def("gather", &gather);
}

}  // namespace oblique::python
