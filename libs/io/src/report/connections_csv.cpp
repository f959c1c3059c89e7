// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/compile.h>

#include <array>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "connection_list.hpp"
#include "holdfast/io/csv.hpp"
#include "holdfast/io/report.hpp"
#include "ordered_blocks.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kNames =
    "ax,ay,az,bx,by,bz,direction,load_ratio,axial_n,bending_nmm,shear_n,torsion_nmm,breaks";

/// Rows that one thread makes at a time, some 60 KB.
constexpr std::size_t kBlockRows = 512;

/// The step that leads to the second module, in axial coordinates: "+x" and so on along one of
/// them, as between cubes; else "-x+z" and the like.
std::string step_name(const base::Lattice& lattice, base::Direction direction) {
  const base::Cell& step = lattice.steps[static_cast<std::size_t>(base::index(direction))];
  std::string name;
  for (const auto& [coordinate, letter] :
       {std::pair{step.x, 'x'}, std::pair{step.y, 'y'}, std::pair{step.z, 'z'}}) {
    if (coordinate != 0) {
      name += coordinate > 0 ? '+' : '-';
      name += letter;
    }
  }
  return name;
}

void append_row(std::string& out, const model::Robot& robot, std::size_t connection,
                const verdict::ConnectionResult& result, const std::vector<MoreNumbers>& more) {
  const auto [a, b] = model::ends(robot, connection);
  for (const base::Cell& cell : {a, b}) {
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("{},{},{},"), cell.x, cell.y, cell.z);
  }
  out += step_name(robot.lattice(), robot.connections()[connection].direction);
  out += ',';
  for (const double number : {result.load_ratio, result.axial_n, result.bending_nmm, result.shear_n,
                              result.torsion_nmm}) {
    append_csv(out, number);
  }
  out += verdict::breaks(result.load_ratio) ? '1' : '0';
  for (const MoreNumbers& column : more) {
    const bool is_known = !column.connections.empty();
    fmt::format_to(
        std::back_inserter(out), FMT_COMPILE(",{}"),
        is_known ? column.connections[connection] + 0.0 : std::numeric_limits<double>::quiet_NaN());
  }
  out += '\n';
}

}  // namespace

void write_connections_csv(std::ostream& out, const model::Robot& robot,
                           const verdict::Assessment& assessment, const ReportOptions& options) {
  const ConnectionList list(assessment, options.connections);
  out << kNames;
  for (const MoreNumbers& column : options.more) {
    out << ',' << column.name;
  }
  out << '\n';
  write_items(out, list.size(), kBlockRows, options.thread_count, options.progress,
              [&](std::size_t begin, std::size_t end, std::string& text) {
                for (std::size_t i = begin; i < end; ++i) {
                  append_row(text, robot, list[i], assessment.connections[list[i]], options.more);
                }
              });
}

}  // namespace holdfast::io
