// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/cluster/program.hpp"

int main(int argc, char** argv) { return holdfast::cluster::run(argc, argv); }
