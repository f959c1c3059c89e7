// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/cluster/program.hpp"

#include <fmt/format.h>
#include <petscsys.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "checkpoint.hpp"
#include "cluster_check.hpp"
#include "holdfast/exit_code.hpp"
#include "holdfast/holdfast.hpp"
#include "parts/generator.hpp"
#include "parts/part_maker.hpp"
#include "parts/structure.hpp"
#include "picture.hpp"
#include "ranks/launcher.hpp"
#include "ranks/shared_text.hpp"

namespace holdfast::cluster {
namespace {

struct Options {
  io::ReadOptions reading;
  std::string file;
  std::string json;
  bool is_quiet = false;
  bool is_bonded = false;
  bool is_traffic_shown = false;
  bool is_multigrid_only = false;
  double memory_gb = 4;
  std::size_t alone_max = 6000;  ///< Up to here one machine may solve directly.
  /// Robots of up to so many modules that ranks cannot decide are checked again on one machine,
  /// which has the direct solver: a second for a solid, a few for a slender robot.
  std::size_t again_max = 100000;
  std::string output;
  std::string family;
  std::size_t size = 0;
  std::string vtk;
  std::string checkpoint;

  std::size_t memory_bytes() const { return static_cast<std::size_t>(memory_gb * 1e9); }
};

/// Whether this is the first rank, for end_on_signal().
bool is_first_rank = false;

/// Address space for those who end all ranks where there is no more: without it OpenMPI, which
/// reads what it says from a file, ends with an exit code of its own. Nothing is written to it.
constexpr std::size_t kReserveBytes = std::size_t{4} << 20;
std::unique_ptr<std::byte[]> reserve;

/// Ends all ranks, with one line.
[[noreturn]] void end_all(const std::string& message) {
  static bool is_ending = false;
  if (std::exchange(is_ending, true)) {
    std::_Exit(kExitFailure);  // Nor has MPI what it takes to end: mpirun sees the code.
  }
  reserve.reset();
  is_first_rank = false;  // It has its own line to say.
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  fmt::print(stderr, "holdfast-mpi: rank {}: {}; no verdict\n", rank, message);
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, kExitFailure);
  std::_Exit(kExitFailure);
}

[[noreturn]] void end_all_on_exception() {
  try {
    std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    end_all("out of memory");
  } catch (const std::exception& exception) {
    end_all(exception.what());
  } catch (...) {
    end_all("an unknown fault");
  }
}

/// mpirun ends the others when a rank dies. Writes nothing but a text that is there already.
void end_on_signal(int) {
  constexpr std::string_view kText =
      "holdfast-mpi: ended from outside, as when another rank dies; no verdict\n";
  if (is_first_rank) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText.data(), kText.size());
  }
  std::_Exit(kExitFailure);
}

/// Ends all ranks when PETSc has an error. PETSc 3.18 reports memory that it does not get with a
/// line number as the code: the macro misreads the first fields of an error that its allocators
/// hand on.
PetscErrorCode end_all_on_petsc_error(MPI_Comm, int, const char* function, const char*,
                                      PetscErrorCode code, PetscErrorType, const char* message,
                                      void*) {
  const std::string_view where = function == nullptr ? "" : function;
  if (code == PETSC_ERR_MEM || where == "PetscMallocAlign" || where == "PetscReallocAlign") {
    end_all("out of memory");
  }
  const char* meaning = nullptr;
  PetscErrorMessage(code, &meaning, nullptr);
  end_all(fmt::format("PETSc: {}: {}", meaning == nullptr ? "a fault" : meaning,
                      message == nullptr ? "" : message));
}

/// Uses large pages, but not where the address space is limited: they are not to be had by the
/// gigabyte.
void use_large_pages_if_unlimited() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) {
    host::use_large_pages();
  }
}

int complain(const PetscRanks& ranks, const base::Error& error, const std::string& file) {
  if (ranks.rank() == 0) {
    fmt::print(stderr, "holdfast-mpi: {}: {}{}{}\n", io::one_line(file), error.message,
               error.where.empty() ? "" : ", at ", error.where);
  }
  return kExitBadInput;
}

/// Prints what a rank takes, for those who plan for a machine.
void show_traffic(PetscRanks& ranks, const Checked& checked) {
  const Traffic traffic = ranks.traffic();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double iterations = std::max(1, checked.assessment.equilibrium.iteration_count);
  const double bytes = ranks.max(static_cast<double>(traffic.halo_bytes));
  const double mb = ranks.max(static_cast<double>(usage.ru_maxrss) / 1024);
  if (ranks.rank() == 0) {
    fmt::print(
        "  traffic     in each iteration: {:.0f} bytes of copies at most in {:.0f} messages to "
        "each "
        "neighbour, {:.0f} sums, {:.0f} bytes gathered; {:.0f} MB at most\n",
        bytes / iterations, static_cast<double>(traffic.halo_count) / iterations,
        static_cast<double>(traffic.sum_count) / iterations,
        static_cast<double>(traffic.gather_bytes) / iterations, mb);
  }
}

/// Writes what the first rank has to say. Returns whether all went well.
bool write_answer(const Options& options, const std::string& text, const std::string& json) {
  if (!options.is_quiet && options.json != "-") {
    fmt::print("{}", text);
    std::fflush(stdout);
  }
  if (options.json.empty()) {
    return true;
  }
  const auto error = write_file(options.json, json);
  if (error) {
    fmt::print(stderr, "holdfast-mpi: {}: {}\n", options.json, error->message);
  }
  return !error;
}

/// Writes a piece of the picture, if one is wanted. Returns whether all went well.
bool write_picture(const Options& options, const Piece& piece,
                   const verdict::Assessment& assessment) {
  if (options.vtk.empty()) {
    return true;
  }
  const auto error = write_piece(options.vtk, piece, assessment);
  if (error) {
    fmt::print(stderr, "holdfast-mpi: {}: {}\n", io::one_line(options.vtk), error->message);
  }
  return !error;
}

/// Hands the first rank's verdict to all ranks.
base::Result<verdict::Verdict> shared(PetscRanks& ranks,
                                      const base::Result<verdict::Verdict>& first) {
  SharedText text;
  text.is_error = !first;
  text.error = first ? base::Error{} : first.error();
  text.document = first ? std::to_string(static_cast<int>(first.value())) : "";
  text = shared_by_first(ranks, text);
  if (text.is_error) {
    return text.error;
  }
  return static_cast<verdict::Verdict>(std::stoi(text.document));
}

/// Checks a robot as one machine does; by multigrid only, if that is asked for.
CheckResult check_by_one(const model::Robot& robot, const Options& options) {
  if (!options.is_multigrid_only) {
    return holdfast::check(robot, {.is_bonded = options.is_bonded,
                                   .thread_count = 1,
                                   .memory_bytes_max = options.memory_bytes()});
  }
  const double start = MPI_Wtime();
  CheckResult result{.assessment =
                         verdict::assess(robot, {.memory_bytes_max = options.memory_bytes(),
                                                 .method = solver::Method::kMultigrid,
                                                 .is_bonded = options.is_bonded,
                                                 .thread_count = 1})};
  result.seconds = MPI_Wtime() - start;
  return result;
}

/// The first rank's answer on a whole robot, as holdfast check gives it.
base::Result<verdict::Verdict> check_whole(const Options& options, const Structure& structure,
                                           const std::vector<Record>& records, bool& is_written) {
  model::RobotSpec spec = structure.common;
  for (const Record& record : records) {
    ((record.flags & Record::kPlanned) != 0 ? spec.planned : spec.existing)
        .push_back(record.place());
    if ((record.flags & Record::kFixed) != 0) {
      spec.fixed.push_back(record.place());
    }
  }
  const auto robot = model::Robot::create(spec, 1);
  if (!robot) {
    return robot.error();
  }
  const CheckResult result = check_by_one(robot.value(), options);
  const io::ReportEntry entry = {.origin = {.file = options.file},
                                 .name = structure.name,
                                 .robot = &robot.value(),
                                 .assessment = &result.assessment,
                                 .warnings = structure.warnings,
                                 .seconds = result.seconds};
  const std::string text = fmt::format("{} {}\n{}", banner(result.assessment.verdict),
                                       io::one_line(structure.name), io::write_report_text(entry));
  is_written =
      write_answer(options, text, io::write_report_json(entry) + "\n") &&
      write_picture(options, {.robot = &robot.value(), .own_count = robot.value().modules().size()},
                    result.assessment);
  return result.assessment.verdict;
}

/// A small robot is one rank's work, with all solvers that there are.
int check_alone(PetscRanks& ranks, const Options& options, const Structure& structure) {
  const auto records = host::gather<Record>(ranks, structure.records);
  bool is_written = true;
  const auto verdict = shared(
      ranks, ranks.rank() == 0 ? check_whole(options, structure, records, is_written)
                               : base::Result<verdict::Verdict>(verdict::Verdict::kUndecided));
  if (!verdict) {
    return complain(ranks, verdict.error(), options.file);
  }
  return host::all(ranks, is_written) ? exit_code(verdict.value()) : kExitBadInput;
}

/// Vectors of PETSc are numbered by PetscInt, which may have 32 bits.
std::optional<base::Error> find_size_fault(std::size_t module_count) {
  constexpr auto kMax = static_cast<std::size_t>(PETSC_MAX_INT) / 6;
  if (module_count <= kMax) {
    return std::nullopt;
  }
  return base::Error{.code = base::ErrorCode::kUnsupported,
                     .message = fmt::format("{} modules, expected at most {}: more take a PETSc of "
                                            "64-bit indices (docs/cluster.md)",
                                            module_count, kMax)};
}

int check_in_parts(PetscRanks& ranks, const Options& options, const Structure& structure) {
  const auto part = make_part(ranks, structure);
  if (!part) {
    return complain(ranks, part.error(), options.file);
  }
  Checkpoint checkpoint(ranks, options.checkpoint, structure.fingerprint,
                        part.value().robot.facets().size());
  const bool is_kept = !options.checkpoint.empty();
  if (is_kept) {
    if (const auto error = checkpoint.read()) {
      return complain(ranks, *error, options.checkpoint);
    }
  }
  const Checked checked = check(part.value(), {.is_bonded = options.is_bonded,
                                               .memory_bytes_max = options.memory_bytes(),
                                               .journal = is_kept ? &checkpoint : nullptr});
  if (checked.assessment.verdict == verdict::Verdict::kUndecided && !options.is_multigrid_only &&
      part.value().counts.all <= options.again_max) {
    const int code = check_alone(ranks, options, structure);
    if (is_kept && code <= kExitUndecided) {
      checkpoint.remove();
    }
    return code;
  }
  bool is_written = write_picture(options,
                                  {.robot = &part.value().robot,
                                   .own_count = part.value().robot.own_count(),
                                   .rank = ranks.rank(),
                                   .rank_count = ranks.count()},
                                  checked.assessment);
  is_written = host::all(ranks, is_written);
  if (ranks.rank() == 0 && is_written) {
    is_written = write_answer(options, report_text(structure, part.value(), checked),
                              report_json(options.file, structure, part.value(), checked));
  }
  is_written = host::all(ranks, is_written);
  if (is_kept && is_written) {
    checkpoint.remove();
  }
  if (options.is_traffic_shown) {
    show_traffic(ranks, checked);
  }
  return is_written ? exit_code(checked.assessment.verdict) : kExitBadInput;
}

int check_file(PetscRanks& ranks, const Options& options) {
  if (!options.vtk.empty()) {
    if (const auto fault = find_name_fault(options.vtk)) {
      return complain(ranks, {.message = *fault}, options.vtk);
    }
  }
  const auto structure = read_structure(ranks, options.file, options.reading);
  if (!structure) {
    return complain(ranks, structure.error(), options.file);
  }
  const std::size_t count = host::total(ranks, structure.value().records.size());
  if (count <= options.alone_max || count < static_cast<std::size_t>(ranks.count())) {
    return check_alone(ranks, options, structure.value());
  }
  if (const auto fault = find_size_fault(count)) {
    return complain(ranks, *fault, options.file);
  }
  return check_in_parts(ranks, options, structure.value());
}

int generate(PetscRanks& ranks, const Options& options) {
  const auto count = generate_in_parts(ranks, options.family, options.size, options.output);
  if (!count) {
    return complain(ranks, count.error(), options.output);
  }
  if (ranks.rank() == 0 && !options.is_quiet) {
    fmt::print("{}: {}\n", options.output, host::counted(count.value(), "module"));
    std::fflush(stdout);
  }
  return 0;
}

int convert(PetscRanks& ranks, const Options& options) {
  int code = 0;
  if (ranks.rank() == 0) {
    const auto text = read_file(options.file);
    auto read = text ? io::read_document(text.value(), options.reading)
                     : base::Result<io::ReadDocument>(text.error());
    const auto written = read ? write_binary(read.value().document, options.output)
                              : base::Result<std::size_t>(read.error());
    if (!written) {
      code = complain(ranks, written.error(), options.file);
    } else if (!options.is_quiet) {
      fmt::print("{}: {}\n", options.output, host::counted(written.value(), "module"));
      std::fflush(stdout);
    }
  }
  return static_cast<int>(ranks.max(code));
}

/// PETSc's options, which begin with one dash, and what follows them are not ours.
std::vector<std::string> own_arguments(int argc, char** argv) {
  std::vector<std::string> own;
  bool is_petsc = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool is_long = argument.starts_with("--") || argument == "-h" || argument == "-o";
    const bool is_short = argument.size() > 1 && argument[0] == '-' && !is_long;
    is_petsc = is_short || (is_petsc && !is_long);
    if (!is_petsc) {
      own.push_back(argument);
    }
  }
  std::ranges::reverse(own);  // As CLI11 wants it.
  return own;
}

/// A value that must be given. The help shows no type beside its name.
template <class Value>
void add_required(CLI::App& command, const std::string& name, Value& value,
                  const std::string& help) {
  command.add_option(name, value, help)->type_name("")->required();
}

void add_file(CLI::App& command, const std::string& name, std::string& file,
              const std::string& help) {
  command.add_option(name, file, help)->type_name("FILE");
}

/// Adds the options for reading that the commands of holdfast have.
void add_reading(CLI::App& command, io::ReadOptions& reading) {
  command.add_option("--robot", reading.robot, "Robot to assume if the file names none")
      ->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--lattice",
          [&reading](const std::string& name) { reading.lattice = io::find_lattice(name).value(); },
          "Lattice to assume if the file names none, as VisibleSim's, or VisibleSim's name of the "
          "modules")
      ->type_name("NAME")
      ->check([](const std::string& name) {
        const auto found = io::find_lattice(name);
        return found ? std::string() : found.error().message;
      });
  command.add_flag("--allow-unknown", reading.allow_unknown,
                   "Ignore keys of holdfast JSON that are unknown, with a note");
}

/// Adds the options that decide whether one rank answers or many.
void add_sizes(CLI::App& check, Options& options) {
  check
      .add_option("--alone-max", options.alone_max,
                  "Robots of no more modules are checked by one rank, as holdfast check does")
      ->type_name("N")
      ->capture_default_str();
  check
      .add_option("--again-max", options.again_max,
                  "Robots of no more modules that ranks leave undecided are checked once more by "
                  "one rank, as holdfast check does")
      ->type_name("N")
      ->capture_default_str();
  check.add_option("--memory", options.memory_gb, "Most memory for the solver, GB, of each rank")
      ->capture_default_str();
}

CLI::App& add_check(CLI::App& app, Options& options) {
  CLI::App& check = *app.add_subcommand("check", "Say whether a structure holds");
  add_required(check, "FILE", options.file, "Structure: binary, VisibleSim XML or holdfast JSON");
  add_reading(check, options.reading);
  add_file(check, "--json", options.json, "Write the report as JSON; - is standard output");
  add_file(check, "--vtk", options.vtk,
           "Write a .pvtu file for ParaView, and beside it a .vtu file of each rank");
  add_file(check, "--checkpoint", options.checkpoint,
           "Keep contact states in this file after every step, go on from those that it has, and "
           "remove it when there is an answer");
  check.add_flag("--quiet", options.is_quiet, "Print errors only; the exit code is the answer");
  check.add_flag("--bonded", options.is_bonded,
                 "Treat the ground as glued: supports can neither lift nor tilt");
  check.add_flag("--traffic", options.is_traffic_shown,
                 "Print what ranks exchange and how much memory they take");
  check.add_flag("--multigrid", options.is_multigrid_only,
                 "Do without the direct solver, on one rank, too, and ask nobody once more: to "
                 "compare iterations");
  add_sizes(check, options);
  check.footer(
      "Exit: 0 safe, 1 overload or unstable, 2 undecided, 64 wrong usage, 65 bad input or not\n"
      "writable, 70 a rank failed or is out of memory.");
  return check;
}

constexpr const char* kWrittenCodes =
    "Exit: 0 written, 64 wrong usage, 65 bad input or not writable, 70 a rank failed or is out of\n"
    "memory.";

CLI::App& add_generate(CLI::App& app, Options& options) {
  CLI::App& generation = *app.add_subcommand(
      "generate", "Write a binary structure of a family, each rank a part of it");
  add_required(generation, "FAMILY", options.family, "As of holdfast generate");
  add_required(generation, "SIZE", options.size, "As of holdfast generate");
  add_file(generation, "-o,--output", options.output, "File to write");
  generation.get_option("--output")->required();
  generation.add_flag("--quiet", options.is_quiet, "Print errors only");
  generation.footer(kWrittenCodes);
  return generation;
}

void add_convert(CLI::App& app, Options& options) {
  CLI::App& conversion = *app.add_subcommand("convert", "Write a binary structure");
  add_required(conversion, "FROM", options.file, "VisibleSim XML or holdfast JSON");
  add_required(conversion, "TO", options.output, "File to write");
  add_reading(conversion, options.reading);
  conversion.footer(kWrittenCodes);
}

int run_command(PetscRanks& ranks, int argc, char** argv) {
  Options options;
  CLI::App app{"Will it hold? For robots that are too large for one machine: in parts, by MPI."};
  app.name("holdfast-mpi");
  app.set_version_flag("--version", "holdfast-mpi " + std::string(holdfast::version()));
  app.require_subcommand(1);
  const CLI::App& check = add_check(app, options);
  const CLI::App& generation = add_generate(app, options);
  add_convert(app, options);
  app.footer(
      "--ranks N, anywhere: start mpirun with N ranks, and give the outcome in one line\n"
      "and one exit code. Without it mpirun or srun starts the ranks.\n"
      "Options with one dash, such as -ksp_monitor or -log_view, are PETSc's; they come last.\n"
      "Exit: 0 safe, 1 unsafe, 2 undecided, 64 wrong usage, 65 bad input or not writable,\n"
      "70 a rank failed or is out of memory.");
  try {
    app.parse(own_arguments(argc, argv));
  } catch (const CLI::ParseError& error) {
    if (ranks.rank() != 0) {
      return error.get_exit_code() == 0 ? 0 : kExitUsage;
    }
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  return check.parsed()        ? check_file(ranks, options)
         : generation.parsed() ? generate(ranks, options)
                               : convert(ranks, options);
}

}  // namespace

int run(int argc, char** argv) {
  if (const auto code = launch({argv + 1, argv + argc})) {
    return *code;
  }
  use_large_pages_if_unlimited();
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  PetscPushErrorHandler(end_all_on_petsc_error, nullptr);
  std::set_terminate(end_all_on_exception);
  reserve.reset(new std::byte[kReserveBytes]);
  std::signal(SIGTERM, end_on_signal);
  int code = 0;
  {
    PetscRanks ranks(PETSC_COMM_WORLD);
    is_first_rank = ranks.rank() == 0;
    code = run_command(ranks, argc, argv);
  }
  std::set_terminate(nullptr);
  // The first rank speaks for all: mpirun would end it when it sees another's code before.
  code = is_first_rank ? rank_exit_code(code) : 0;
  is_first_rank = false;
  PetscFinalize();
  return code;
}

}  // namespace holdfast::cluster
