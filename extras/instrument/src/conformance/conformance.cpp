// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "cases.hpp"
#include "holdfast/module/configuration.hpp"

namespace holdfast::instrument {

bool Check::expect(bool is_so, const std::string& expected, const std::string& found) {
  if (!is_so && is_passed()) {
    result_.outcome = ConformanceCase::Outcome::kFailed;
    result_.sent = by_hand::text(partner.said());
    result_.expected = expected;
    result_.found = found;
  }
  return is_so;
}

bool Check::expect_bytes(const Bytes& expected, const std::optional<Bytes>& found) {
  return expect(found == expected, by_hand::text(expected),
                found ? by_hand::text(*found) : std::string("nothing"));
}

bool Check::expect_messages(const Bytes& expected) {
  const Bytes found = partner.take(expected.size());
  return expect(found == expected, by_hand::text(expected),
                found.empty() ? std::string("nothing") : by_hand::text(found));
}

bool Check::expect_silence(const std::optional<Bytes>& found) {
  return expect(!found, "nothing", found ? by_hand::text(*found) : std::string());
}

void Check::absent(const std::string& why) {
  if (is_passed()) {
    result_.outcome = ConformanceCase::Outcome::kAbsent;
    result_.found = why;
  }
}

}  // namespace holdfast::instrument

namespace holdfast {

using instrument::Case;
using instrument::Check;
using instrument::Partner;

std::vector<std::uint8_t> conformance_page() {
  // Module 10 of the conversation in docs/evidence/wire.md, and its neighbours.
  const auto structure = load_text(
      R"({"format": "holdfast-structure", "version": 1, "support_z": 0,
          "modules": [[-1, 2, 0], [0, 2, 0], [0, 3, 0]]})");
  module::Configuration configuration;
  std::vector<std::uint8_t> page =
      emulator::configuration_pages(structure.value().robot, {}).front();
  std::memcpy(static_cast<void*>(&configuration), page.data(), page.size());
  configuration.setup.timing.retransmit_after = 50'000;
  configuration.identity.id = Partner::kTheirId;
  configuration.checksum = module::checksum_of(configuration);
  std::memcpy(page.data(), &configuration, page.size());
  return page;
}

namespace {

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const auto some :
       {instrument::line_cases(), instrument::link_cases(), instrument::round_cases()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// A byte that is lost, or a computer that is busy for a moment, is no fault of the module's: what
/// fails is tried again.
ConformanceCase try_case(Partner& partner, const Case& one) {
  constexpr int kAttemptsMax = 3;
  ConformanceCase result;
  for (int attempt = 1; attempt <= kAttemptsMax; ++attempt) {
    partner.leave();
    Check check(partner);
    one.run(check);
    result = check.result();
    result.attempts = attempt;
    if (result.outcome != ConformanceCase::Outcome::kFailed) {
      break;
    }
  }
  result.section = one.section;
  result.name = one.name;
  return result;
}

}  // namespace

std::vector<std::string> conformance_sections() {
  std::vector<std::string> sections;
  for (const Case& one : all_cases()) {
    if (sections.empty() || sections.back() != one.section) {
      sections.emplace_back(one.section);
    }
  }
  return sections;
}

base::Result<std::vector<ConformanceCase>> check_conformance(
    const std::string& device, const std::string& section, const InstrumentOptions& options,
    const std::function<bool(const ConformanceCase&)>& tell) {
  auto opened = instrument::SerialDevice::open(device, options.baud);
  if (!opened) {
    return opened.error();
  }
  Partner partner(std::move(opened).value());
  partner.leave();
  if (!partner.meet()) {
    return base::Error{.code = base::ErrorCode::kUnreadable,
                       .message =
                           "nobody greets; is face +x of a module at this device, at this "
                           "rate, and is the module on?",
                       .where = device};
  }
  std::vector<ConformanceCase> results;
  for (const Case& one : all_cases()) {
    if (section.empty() || section == one.section) {
      results.push_back(try_case(partner, one));
      if (!tell(results.back())) {
        break;
      }
    }
  }
  return results;
}

}  // namespace holdfast
