#!/usr/bin/env bash
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# cluster.sh PROGRAMS PEERS [FAMILY SIZE [TURNS]]
# One robot on one machine's threads and on ranks; what ranks exchange; PETSc's own preconditioners.
#
# PROGRAMS holds holdfast and holdfast-mpi, PEERS petsc_bench. Times are what reports say of the
# solution, without reading the file, each run a process of its own, TURNS of each in turn (5), of
# which the fastest and the median are printed; so they want a quiet machine of two cores. PETSc
# solves the same robot with bonded feet, its matrix assembled, as far as a residual of 1e-6.
# Families are those that holdfast-mpi generates; cube 100 if none is named.
set -euo pipefail
programs=$1
peers=$2
family=${3:-cube}
size=${4:-100}
turns=${5:-5}
limit_s=${HOLDFAST_LIMIT_S:-300}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none

ranks() { # COUNT PROGRAM ARGUMENTS...: ranks that share cores sleep where they wait
  local count=$1 yield=0
  shift
  [ "$count" -le "$(nproc)" ] || yield=1
  OMPI_MCA_mpi_yield_when_idle=$yield timeout "$limit_s" mpirun -n "$count" "$@"
}

check() { # THREADS-OR-RANKS COUNT: seconds and iterations of one run
  local report=$work/report.json code=0
  case $1 in
    threads) "$programs/holdfast" check "$work/robot.json" --threads "$2" --connections 0 --quiet \
      --json "$report" || code=$? ;;
    ranks) ranks "$2" "$programs/holdfast-mpi" check "$work/robot.holdfast" --alone-max 0 --quiet \
      --json "$report" || code=$? ;;
  esac
  [ "$code" -le 2 ] || { echo "check on $2 $1 failed with $code" >&2; return 70; }
  python3 -c 'import json, sys
report = json.load(open(sys.argv[1], encoding="utf-8"))
solver = report["solver"]
print(solver["seconds"], solver["multigrid_iterations"], report["verdict"])' "$report"
}

times() { # 1 and 2 threads, 1 and 2 ranks, in turn
  local run kind count
  for ((turn = 0; turn < turns; ++turn)); do
    for run in "threads 1" "threads 2" "ranks 1" "ranks 2"; do
      read -r kind count <<<"$run"
      check "$kind" "$count" >>"$work/$run"
    done
  done
  local two_threads
  two_threads=$(sort -g "$work/threads 2" |
    awk '{ at[NR] = $1 } END { print at[int((NR + 1) / 2)] }')
  printf '\n%-12s %10s %10s %22s %11s  %s\n' on 'fastest s' 'median s' \
    'times as two threads' iterations verdict
  for run in "threads 1" "threads 2" "ranks 1" "ranks 2"; do
    sort -g "$work/$run" | awk -v run="$run" -v two="$two_threads" '
      { at[NR] = $1; iterations = $2; verdict = $3 }
      END { median = at[int((NR + 1) / 2)]; split(run, name, " ")
            printf "%-12s %10.3f %10.3f %22.2f %11d  %s\n", name[2] " " name[1], at[1], median,
              median / two, iterations, verdict }'
  done
}

traffic() { # what ranks exchange, for 1 to 64 of them
  printf '\n%-6s %10s %14s %8s %10s %14s %6s\n' ranks iterations 'bytes copied' updates \
    reductions 'bytes gathered' MB
  local count said
  for count in 1 2 4 8 16 32 64; do
    said=$(ranks "$count" "$programs/holdfast-mpi" check "$work/robot.holdfast" --alone-max 0 \
      --traffic) || [ $? -le 2 ]
    awk -v ranks="$count" '
      / iterations? of multigrid/ { for (i = 2; i <= NF; ++i)
          if ($i ~ /^iterations?$/) n = $(i - 1) }
      /^  traffic/ { gsub(/[^0-9. ]/, ""); printf "%-6s %10s %14s %8s %10s %14s %6s\n",
                     ranks, n, $1, $2, $3, $4, $5 }' <<<"$said"
  done
}

petsc() { # PETSc's preconditioners on the assembled matrix
  local count pc line
  [ -x "$peers/petsc_bench" ] || { printf '\nno PETSc to compare with\n'; return; }
  printf '\n%-22s %10s %8s %11s\n' 'PETSc CG, bonded' seconds MB iterations
  for count in 1 2 4; do
    for pc in jacobi bjacobi gamg hypre; do
      if line=$(ranks "$count" "$peers/petsc_bench" "$family" "$size" /dev/null -pc_type "$pc" \
        2>/dev/null | tail -1) && [ -n "$line" ]; then
        awk -v name="$pc, $count ranks" '{ printf "%-22s %10.3f %8.0f %11d\n", name, $2, $3, $4 }' \
          <<<"$line"
      else
        printf '%-22s failed, or took more than %s s\n' "$pc, $count ranks" "$limit_s"
      fi
    done
  done
}

"$programs/holdfast" generate "$family" "$size" -o "$work/robot.json"
ranks 1 "$programs/holdfast-mpi" convert "$work/robot.json" "$work/robot.holdfast"
times
traffic
petsc
