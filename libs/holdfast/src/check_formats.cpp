// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/check_formats.hpp"

#include <algorithm>
#include <iterator>

namespace holdfast {
namespace {

void write_vtu(std::ostream& out, const Structure& structure, const CheckResult& result,
               const io::ReportOptions& options) {
  const std::vector<model::Obstacle>& obstacles = structure.document.extension.obstacles;
  if (result.deformed && !result.deformed->last.poses.empty()) {
    const large::Path& path = *result.deformed;
    io::write_deformed_vtu(out, structure.robot, result.assessment,
                           path.loaded ? path.loaded->factor : path.last.factor, options,
                           obstacles);
    return;
  }
  io::write_vtu(out, structure.robot, result.assessment, options, obstacles);
}

constexpr CheckFormat kCheckFormats[] = {
    {"json", "--json", "Write the whole report as JSON; - is standard output", FileFormat::kJson,
     [](std::ostream& out, const Structure& structure, const CheckResult& result,
        const io::ReportOptions& options) { write_report_json(out, structure, result, options); }},
    {"csv", "--csv", "Write a table, a line for each connection with its loads", FileFormat::kCsv,
     [](std::ostream& out, const Structure& structure, const CheckResult& result,
        const io::ReportOptions& options) {
       io::write_connections_csv(out, structure.robot, result.assessment, options);
     }},
    {"vtu", "--vtk",
     "Write a .vtu file for ParaView; with a .pvd name and --deformed the whole path, with "
     "--cascade the fall",
     FileFormat::kVtu, write_vtu}};

template <class Fits>
const CheckFormat* find(const Fits& fits) {
  const auto* const row = std::ranges::find_if(kCheckFormats, fits);
  return row == std::end(kCheckFormats) ? nullptr : row;
}

}  // namespace

std::span<const CheckFormat> check_formats() { return kCheckFormats; }

const CheckFormat* find_check_format(std::string_view name) {
  return find([&](const CheckFormat& row) { return row.name == name; });
}

const CheckFormat* find_check_format_of(std::string_view path) {
  return find([&](const CheckFormat& row) { return has_ending_of(row.file, path); });
}

}  // namespace holdfast
