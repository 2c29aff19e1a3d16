// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <oblique/commission/judge.h>
#include <oblique/diagram/block_library.h>
#include <oblique/patch/patch.h>

namespace oblique::cli {

/// Exit status of the program (formats.md).
enum class ExitStatus { done = 0, no = 1, bad_request = 2, solver_failed = 3 };

/// The options of the program itself.
struct Session {
  std::vector<std::filesystem::path> block_directories;

  /// The shipped blocks and those of `--blocks`. Throws DiagramError.
  diagram::BlockLibrary blocks() const;
};

// One request and one function a verb. Options are texts where they may carry units. Empty: not given.

struct RunRequest {
  std::string diagram;
  std::string output;
  std::vector<std::string> columns;  ///< those to write and to draw; empty: all
  std::string plot;                  ///< where the curves go; "-": the terminal
  std::string theme;                 ///< of the drawing; empty: auto
  std::string against;               ///< the column that the others are drawn against; empty: `t`
  std::string until;
  std::vector<std::string> settings;
  std::optional<int> step;  ///< of the lesson, from 1
  std::string vary;         ///< NAME=VALUES: a run for each value
  std::string from;         ///< a state file to go on from
  std::string save;         ///< where the state at the end goes
  bool check = false;
  bool events = false;
  bool static_test = false;
  bool halt_on_overload = false;
  bool trust = false;                    ///< estimate the errors
  std::vector<std::string> sensitivity;  ///< parameters by which the outputs are differentiated
};
ExitStatus run_diagram(const Session& session, const RunRequest& request);

struct SweepRequest {
  std::string file;
  std::string output;
  std::string plan;  ///< where it is written as a plan
  std::vector<std::string> vary, measures, scatter;
  std::string tolerance_of_elements;
  std::string machine;
  std::optional<std::uint64_t> runs;
  bool latin = false, sobol = false;
  std::uint64_t seed = 1;
  std::string gain, method;  ///< of a mechanism
  std::string tolerance;
  std::optional<int> samples;
  int jobs = 0;       ///< 0: as many as the processor has
  std::string plot;   ///< where the picture goes; "-": the terminal
  std::string theme;  ///< of the picture; empty: auto
};
ExitStatus sweep(const Session& session, const SweepRequest& request);

struct OperateRequest {
  std::string diagram;
};
ExitStatus operate(const Session& session, const OperateRequest& request);

struct CheckRequest {
  std::string file;
  std::string output;
  bool json = false;
  bool rescale = false;
  std::string plot;   ///< where the eigenvalues go; "-": the terminal
  std::string theme;  ///< of the drawing; empty: auto
};
ExitStatus check_file(const Session& session, const CheckRequest& request);

struct SolveRequest {
  std::string mechanism;
  std::string output;
  std::string until;
  std::string at_limit;
  std::vector<std::string> columns;  ///< those to write; empty: all
  int positions = 361;
  bool check = false;
  bool analysis = false;
};
ExitStatus solve_mechanism(const Session& session, const SolveRequest& request);

struct ModesRequest {
  std::string mechanism;
  std::string at;
  bool json = false;
};
ExitStatus show_modes(const Session& session, const ModesRequest& request);

/// The method of patching that --method names. Throws ReadError.
patch::PatchMethod method_option(const std::string& text);

/// How the triads of a mechanism are taken apart.
struct TriadChoice {
  std::vector<std::string> split;
  std::string slower;  ///< empty: as it takes
};

/// One patch that is run beside other work.
struct PatchChoice {
  std::string gain = "1e6";
  std::string bandwidth;
  std::string method = "triangles";
  TriadChoice triads;
};

struct PatchRequest {
  std::string mechanism;  ///< or diagram, for a machine
  std::string output;
  std::string gain = "1e6";
  std::string bandwidth;
  std::string method = "triangles";
  bool derivatives = false;
  std::string unit;
  std::string period;
  TriadChoice triads;
  std::string machine;     ///< in whose elements
  std::string sheets;      ///< how the names of its sheets begin
  std::string time_scale;  ///< of a diagram: 1 s of it in so many of the machine; empty: as it takes
  int segments = 0;        ///< of a diagram: straight lines of a function generator; 0: the usual number
  bool force = false;
};
ExitStatus patch_file(const Session& session, const PatchRequest& request);

struct CompareRequest {
  std::string mechanism;
  std::string output;
  std::vector<std::string> gains;  ///< empty: those of CompareOptions
  std::vector<std::string> bandwidths;
  std::vector<std::string> methods{"triangles"};
  TriadChoice triads;
  std::string machine;  ///< in whose elements besides
  bool budget = false;  ///< whose tolerances the errors come from
  int runs = 0;         ///< of --monte-carlo; 0: none
  std::uint64_t seed = 1;
  std::uint64_t first_run = 0;
  int threads = 0;           ///< 0: as many as the processor has
  std::string yield;         ///< below which error a machine is good
  std::string until_within;  ///< how well the part of good ones is to be known
  std::string tolerance;
  bool json = false;
  bool timings = false;  ///< in the JSON
  std::string plot;      ///< where the curves go; "-": the terminal
  std::string theme;     ///< of the drawing; empty: auto
};
ExitStatus compare_mechanism(const Session& session, const CompareRequest& request);

struct ReportRequest {
  std::string file;
  std::string output;
  PatchChoice patch;
  std::string machine;  ///< whose pot sheet stands in it
  std::string theme = "auto";
};
/// Reports on a mechanism or a diagram.
ExitStatus report_file(const Session& session, const ReportRequest& request);

struct AtlasRequest {
  std::string folder;
  std::string output;  ///< the folder of the pages; empty: none are written
  std::string studio;  ///< the studio's page, which they lead to; empty: they do not
  std::string theme = "auto";
};
/// Runs the published programmes of a folder.
ExitStatus run_atlas(const Session& session, const AtlasRequest& request);

struct FitRequest {
  std::string mechanism;
  std::string path;
  std::vector<std::string> free;
  std::string output;
  int starts = 8;
};
ExitStatus fit_mechanism(const Session& session, const FitRequest& request);

struct DrawRequest {
  std::string file;
  std::string output;
  std::string theme = "auto";
  std::string at;
  std::vector<std::string> trace;  ///< points; empty: those worth it; "none"
  int positions = 1;
  std::string plots;    ///< the point that is plotted instead
  std::string magnify;  ///< how many times the errors of the patch are enlarged; empty: it is not drawn
  PatchChoice patch;
  std::string symbols;       ///< of a diagram: classic or din
  std::optional<int> depth;  ///< of a diagram: levels of composites shown open
  bool layout = false;       ///< of a diagram: its [layout] is printed in place of a picture
};
/// Draws a diagram, or prints its layout; `text` is that of the request's file.
ExitStatus draw_diagram_file(const Session& session, const DrawRequest& request, const std::string& text);
/// Draws a mechanism or a diagram.
ExitStatus draw_file(const Session& session, const DrawRequest& request);

/// Positions in a round of an animation.
inline constexpr int kLeastFrames = 8, kMostFrames = 3600;

struct AnimateRequest {
  std::string mechanism;
  std::string output;
  std::string theme = "auto";
  std::vector<std::string> trace;
  std::optional<int> frames;
  std::string duration;
  std::string rate;         ///< frames a second, of a GIF
  std::optional<int> size;  ///< width [px]
  std::string magnify;      ///< as in DrawRequest
  PatchChoice patch;
};
ExitStatus animate_mechanism(const Session& session, const AnimateRequest& request);

struct EnsembleRequest {
  std::string plan;
  std::string folder;          ///< of the chunks
  std::string chunk;           ///< "i/n"; empty: all of them
  std::optional<long> chunks;  ///< into how many the ensemble is cut
  int jobs = 0;                ///< threads; 0: as many as the processor has
  std::string table;
  bool slurm = false;
  std::string time, memory;  ///< of each job
  std::string output;        ///< of the script; empty: stdout
};
ExitStatus run_ensemble(const Session& session, const EnsembleRequest& request);
ExitStatus gather_ensemble(const Session& session, const EnsembleRequest& request);
ExitStatus show_ensemble(const Session& session, const EnsembleRequest& request);
ExitStatus script_ensemble(const Session& session, const EnsembleRequest& request);

struct BlocksRequest {
  std::string name;
};
ExitStatus show_blocks(const Session& session, const BlocksRequest& request);

struct StudioRequest {
  std::string file;    ///< diagram or mechanism; empty: what the page opens with
  std::string output;  ///< where the page goes; empty: into the user's cache
  bool stay = false;   ///< open no browser
};
ExitStatus write_studio(const Session& session, const StudioRequest& request);

struct MachinesRequest {
  std::string name;
  bool json = false;
};
ExitStatus show_machines(const Session& session, const MachinesRequest& request);

}  // namespace oblique::cli
