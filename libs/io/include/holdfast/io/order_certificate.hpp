// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/plan/order.hpp"

/// The file that proves that there is no order; see docs/formats.md. And the file of steps of one
/// that there is.
namespace holdfast::io {

/// The task's target: all modules of a document, planned ones as well, exist. Errors: those of
/// make_spec(); the document has further steps.
base::Result<model::RobotSpec> order_target(const Document& document);

/// The certificate of a task whose target is the document's.
std::string write_order_certificate(const Document& target,
                                    const plan::OrderCertificate& certificate);

/// A certificate, and the name of its target, which may be empty.
struct NamedOrderCertificate {
  std::string name;
  plan::OrderCertificate certificate;
};

base::Result<NamedOrderCertificate> read_order_certificate(std::string_view text);

/// Whether a text says that it is a certificate of an order.
bool is_order_certificate(std::string_view text);

/// The structure with all modules that are there or that its steps attach, and without steps.
Document with_all_modules(Document document);

/// The structure without the modules in some of its cells; it has no steps.
Document without_modules(Document document, std::vector<base::Cell> cells);

/// A structure whose modules are those of the order's start and whose steps attach all others (or,
/// of an order that was not found, those that were reached), or where the robot is taken apart one
/// whose modules are the target's and whose steps detach them.
/// If one that is attached has a kind or a mass of its own the steps are planned ones and say so.
base::Result<Document> order_steps(const Document& target, const plan::Order& order,
                                   bool is_reversed);

}  // namespace holdfast::io
