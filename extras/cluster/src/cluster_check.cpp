// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cluster_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/text.hpp"

namespace holdfast::cluster {
namespace {

using verdict::Assessment;

/// No more broken connections than this are listed.
constexpr std::size_t kBrokenMax = 1000;

struct BrokenConnection {
  double load_ratio = 0;
  std::array<base::Cell, 2> ends{};
};

/// The connections of all ranks with the largest load ratios.
std::vector<std::array<base::Cell, 2>> broken_of_all(const Part& part,
                                                     const Assessment& assessment) {
  std::vector<BrokenConnection> mine;
  for (std::size_t i = 0; i < std::min(kBrokenMax, assessment.broken.size()); ++i) {
    const std::size_t connection = assessment.broken[i];
    mine.push_back({.load_ratio = assessment.connections[connection].load_ratio,
                    .ends = model::ends(part.robot, connection)});
  }
  auto all = host::gather<BrokenConnection>(part.robot.ranks(), mine);
  std::ranges::stable_sort(all, std::ranges::greater(), &BrokenConnection::load_ratio);
  std::vector<std::array<base::Cell, 2>> ends;
  for (std::size_t i = 0; i < std::min(kBrokenMax, all.size()); ++i) {
    ends.push_back(all[i].ends);
  }
  return ends;
}

std::string range_text(const Assessment& assessment) {
  return fmt::format("{:.9g}, known to lie between {:.9g} and {:.9g}", *assessment.load_ratio_max,
                     assessment.load_ratio_range.low, assessment.load_ratio_range.high);
}

}  // namespace

Checked check(const Part& part, const CheckOptions& options) {
  const double start = MPI_Wtime();
  Checked checked;
  checked.assessment = verdict::assess(part.robot, {.memory_bytes_max = options.memory_bytes_max,
                                                    .method = solver::Method::kMultigrid,
                                                    .is_bonded = options.is_bonded,
                                                    .thread_count = options.thread_count,
                                                    .journal = options.journal});
  checked.seconds = part.robot.ranks().max(MPI_Wtime() - start);
  checked.broken = broken_of_all(part, checked.assessment);
  return checked;
}

std::string banner(verdict::Verdict verdict) {
  std::string word = verdict::name(verdict);
  std::ranges::transform(word, word.begin(),
                         [](char letter) { return static_cast<char>(letter - 'a' + 'A'); });
  return fmt::format("{:<9}", word);
}

std::string report_json(const std::string& file, const Structure& structure, const Part& part,
                        const Checked& checked) {
  const io::WholeRobot whole = {.existing_count = part.counts.all - part.counts.planned,
                                .planned_count = part.counts.planned,
                                .facet_count = part.counts.facets,
                                .fixed_count = part.counts.fixed,
                                .broken = checked.broken};
  std::ostringstream out;
  io::write_report_json(out,
                        {.origin = {.file = file},
                         .name = structure.name,
                         .robot = &part.robot,
                         .assessment = &checked.assessment,
                         .warnings = structure.warnings,
                         .seconds = checked.seconds,
                         .whole = &whole},
                        {});
  return std::move(out).str() + "\n";
}

std::string report_text(const Structure& structure, const Part& part, const Checked& checked) {
  const Assessment& assessment = checked.assessment;
  std::string text =
      fmt::format("{} {}\n", banner(assessment.verdict), io::one_line(structure.name));
  for (const verdict::Reason& reason : assessment.reasons) {
    text += fmt::format("  {}\n", io::reason_text(part.robot, reason));
  }
  text += fmt::format("\n  modules     {}, {} of them planned, {} on the ground, {} fixed\n",
                      part.counts.all, part.counts.planned,
                      host::counted(part.counts.facets, "facet"), part.counts.fixed);
  if (assessment.simplified.margin_mm) {
    text += fmt::format("  stability   margin {} mm\n",
                        host::fixed(*assessment.simplified.margin_mm, 2));
  }
  if (assessment.load_ratio_max) {
    text += fmt::format("  load ratio  {}\n", range_text(assessment));
  }
  text += fmt::format("  contact     {}; {}, {} of multigrid in {:.2f} s on {}\n",
                      verdict::name(assessment.contact_model),
                      host::counted(assessment.equilibrium.steps, "linear solve"),
                      host::counted(assessment.equilibrium.iteration_count, "iteration"),
                      checked.seconds, host::counted(part.robot.ranks().count(), "rank"));
  for (const std::string& warning : structure.warnings) {
    text += fmt::format("  note        {}\n", warning);
  }
  return text;
}

}  // namespace holdfast::cluster
