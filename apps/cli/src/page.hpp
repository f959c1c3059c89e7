// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/holdfast.hpp"

/// The page (apps/web) with a structure in it: one HTML file that needs no network.
namespace holdfast::cli {

/// The page, which `./dev page` builds and `cmake --install` installs. The error says where it was
/// looked for and what to do.
base::Result<std::string> find_page();

/// The page with the structure, with a report that is shown at first if there is one, and with the
/// limit load, if it was sought. Errors: the page has no place for it.
base::Result<std::string> fill_page(std::string_view page, const Structure& structure,
                                    const std::optional<std::string>& report,
                                    const std::optional<limit::LimitLoad>& limit = {});

/// Opens a file in the user's browser; false if there is no program that does.
bool open_in_browser(const std::string& path);

}  // namespace holdfast::cli
