// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "holdfast/io/report_page.hpp"
#include "holdfast/steps.hpp"

namespace holdfast {

/// The curves, and the film strip where the robot stays in one piece.
std::vector<std::string> steps_pictures(const StepsFile& file, const StepsResult& result,
                                        const StepsOptions& options);

/// The name of a robot: the document's, or that of the file without folder and ending.
std::string name_of(const io::Document& document, const io::ReportOrigin& origin);

/// The page of a plan that was found: the report for people, then its steps, judged, and their
/// pictures, if there are any.
std::string plan_html(io::ReportPage page, io::Document steps, int thread_count);

}  // namespace holdfast
