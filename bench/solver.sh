#!/usr/bin/env bash
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# solver.sh FOLDER [scale | [FAMILY SIZE]...]
# Our solver and its peers on the same structures, in turn.
#
# FOLDER holds the programs. Each run is a process of its own; ours runs between the peers, and of
# its runs the median counts. HOLDFAST_CLOCK=processor: seconds of the processor, of all threads.
# Prints a table and writes FOLDER/solver.csv.
# Without structures: the three of the published comparison. With "scale" instead: 10^4 to 10^6
# modules of every family, ours alone, and the plots of docs/.
set -euo pipefail
folder=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=2 OPENBLAS_NUM_THREADS=2
csv=$folder/solver.csv
limit_s=${HOLDFAST_LIMIT_S:-300}
[ $# -gt 0 ] || set -- portal 200 scaffold 61 cube 46

echo "solver,family,size,modules,seconds,mb,iterations,error,ratio" >"$csv"
printf '%-34s %-14s %9s %10s %8s %6s %9s %8s\n' solver structure modules seconds MB its error ratio

row() { # SOLVER FAMILY SIZE MODULES SECONDS MB ITERATIONS ERROR OURS
  local ratio=-
  [ "$9" = - ] || ratio=$(awk -v a="$5" -v b="$9" 'BEGIN { printf "%.1f", a / b }')
  printf '%-34s %-14s %9s %10.4f %8.0f %6s %9s %8s\n' "$1" "$2 $3" "$4" "$5" "$6" "$7" "$8" "$ratio"
  echo "$1,$2,$3,$4,$5,$6,$7,$8,$ratio" >>"$csv"
}

ours() { # FAMILY SIZE SUPPORT THREADS
  "$folder/solver_bench" holdfast "$1" "$2" "$3" "$4" "$work/ours.bin"
}

error_of() { # FAMILY SIZE FILE
  if [ -f "$work/reference.bin" ]; then
    "$folder/solver_bench" compare "$1" "$2" "$3" "$work/reference.bin"
  else
    echo -
  fi
}

median() { sort -g -k2 "$1" | awk '{ line[NR] = $0 } END { print line[int((NR + 1) / 2)] }'; }

petsc() { # RANKS FAMILY SIZE OPTIONS...
  local ranks=$1 family=$2 size=$3
  shift 3
  timeout "$limit_s" mpirun --allow-run-as-root --oversubscribe -n "$ranks" \
    "$folder/petsc_bench" "$family" "$size" "$work/peer.bin" "$@" 2>/dev/null
}

peer() { # NAME FAMILY SIZE COMMAND...: one run of a peer, then one of ours
  local name=$1 family=$2 size=$3 line
  shift 3
  if line=$("$@" | tail -1) && [ -n "$line" ]; then
    echo "$name|$line|$(error_of "$family" "$size" "$work/peer.bin")" >>"$work/peers"
  else
    echo "$name||" >>"$work/peers"
  fi
  ours "$family" "$size" bonded 2 >>"$work/ours"
}

compare() { # FAMILY SIZE
  local family=$1 size=$2 modules seconds mb its name line error own
  rm -f "$work"/{ours,peers,reference.bin}
  "$folder/solver_bench" reference "$family" "$size" "$work/reference.bin" || true
  ours "$family" "$size" bonded 2 >"$work/ours"
  peer "CHOLMOD" "$family" "$size" timeout "$limit_s" "$folder/cholmod_bench" "$family" \
    "$size" "$work/peer.bin"
  if [ -x "$folder/petsc_bench" ]; then
    for ranks in 1 2; do
      for pc in jacobi bjacobi gamg hypre; do
        peer "PETSc CG $pc $ranks ranks" "$family" "$size" petsc "$ranks" "$family" "$size" \
          -pc_type "$pc"
      done
    done
  fi
  read -r modules own mb its <<<"$(median "$work/ours")"
  row "holdfast bonded 2 threads" "$family" "$size" "$modules" "$own" "$mb" "$its" \
    "$(error_of "$family" "$size" "$work/ours.bin")" "$own"
  for run in "bonded 1" "contact 2"; do
    read -r support threads <<<"$run"
    for _ in 1 2 3; do ours "$family" "$size" "$support" "$threads"; done >"$work/more" || true
    read -r modules seconds mb its <<<"$(median "$work/more")"
    row "holdfast $support $threads threads" "$family" "$size" "$modules" "$seconds" "$mb" \
      "$its" - "$own"
  done
  while IFS='|' read -r name line error; do
    if [ -z "$line" ]; then
      printf '%-34s %-14s failed, or took more than %s s\n' "$name" "$family $size" "$limit_s"
      continue
    fi
    read -r modules seconds mb its <<<"$line"
    row "$name" "$family" "$size" "$modules" "$seconds" "$mb" "$its" "$error" "$own"
  done <"$work/peers"
}

scale() { # ours alone, from 10^4 to 10^6 modules
  local family size modules seconds mb its
  rm -f "$work/reference.bin"
  for run in "cube 22" "cube 46" "cube 100" "scaffold 40" "scaffold 85" "scaffold 184" \
    "shell 45" "shell 142" "shell 448" "growth 10000" "growth 100000" "growth 1000000" \
    "portal 320" "portal 3130" "portal 31250" "tower 1100" "tower 11000" "tower 111111" \
    "bridge 400" "bridge 4000" "bridge 41600"; do
    read -r family size <<<"$run"
    if for _ in 1 2 3; do ours "$family" "$size" bonded 2; done >"$work/more"; then
      read -r modules seconds mb its <<<"$(median "$work/more")"
      row "holdfast bonded 2 threads" "$family" "$size" "$modules" "$seconds" "$mb" "$its" - -
    else
      printf '%-34s %-14s no answer\n' "holdfast bonded 2 threads" "$family $size"
    fi
  done
}

echo "bandwidth of a triad on 2 threads: $("$folder/solver_bench" bandwidth) GB/s"
plot() { # COLUMN TITLE Y-LABEL PICTURE
  awk -F, -v column="$1" 'NR > 1 {
    print $2, $4, column == 0 ? 1e6 * $5 / $4 : column == 1 ? 1e6 * $6 / $4 : $7 }' "$csv" |
    python3 tools/plot_lines.py "$2" modules "$3" >"docs/$4"
}

if [ "$1" = scale ]; then
  scale
  plot 0 "From cells to load ratios, two threads" "us per module" solver_time.svg
  plot 1 "Memory of the whole program" "bytes per module" solver_memory.svg
  plot 2 "Iterations" "iterations" solver_iterations.svg
else
  while [ $# -ge 2 ]; do
    compare "$1" "$2"
    shift 2
  done
fi
echo "table: $csv"
