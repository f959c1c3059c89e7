# Completions of holdfast for bash, by tools/manual.py from --help.
_holdfast() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local words='' files=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "check steps next order move simulate emulate listen tell twin conformance serve convert fit generate robots view -h --help -V --version" -- "$current")
    return
  fi
  case ${COMP_WORDS[1]} in
    check)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        --json) files=1 ;;
        --csv) files=1 ;;
        --vtk) files=1 ;;
        --connections) words="all broken" ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        --html) files=1 ;;
        --certificate) files=1 ;;
        --limit-seconds) : ;;
        --up-to) : ;;
        --scatter) : ;;
        --scatter-common) : ;;
        --scatter-mass) : ;;
        --scatter-law) words="lognormal normal weibull" ;;
        --probability) : ;;
        --lose) : ;;
        --lose-seconds) : ;;
        --threads) : ;;
        --memory) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin --json --csv --vtk --connections --svg --size --title --grey --view --no-legend --html --certificate --prove --buckling --limit --limit-seconds --remedies --deformed --up-to --follow --scatter --scatter-common --scatter-mass --scatter-law --probability --lose-one --lose --lose-seconds --cascade -q --quiet --bonded --threads --memory"; else files=1; fi ;;
      esac
      ;;
    steps)
      case $previous in
        --scatter) : ;;
        --scatter-common) : ;;
        --scatter-mass) : ;;
        --scatter-law) words="lognormal normal weibull" ;;
        --probability) : ;;
        --lose) : ;;
        --lose-seconds) : ;;
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        --json) files=1 ;;
        --csv) files=1 ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        --step) words="start" ;;
        --html) files=1 ;;
        --vtk) files=1 ;;
        --motions) : ;;
        --threads) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --scatter --scatter-common --scatter-mass --scatter-law --probability --lose-one --lose --lose-seconds --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin --json --csv --svg --size --title --grey --view --no-legend --step --strip --html --vtk --until-unsafe --exact --motions --verify -q --quiet --threads"; else files=1; fi ;;
      esac
      ;;
    next)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        --scatter) : ;;
        --scatter-common) : ;;
        --scatter-mass) : ;;
        --scatter-law) words="lognormal normal weibull" ;;
        --probability) : ;;
        --lose) : ;;
        --lose-seconds) : ;;
        --json) files=1 ;;
        --csv) files=1 ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        --html) files=1 ;;
        --limit) : ;;
        --seconds) : ;;
        --threads) : ;;
        --memory) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin --scatter --scatter-common --scatter-mass --scatter-law --probability --lose-one --lose --lose-seconds --json --csv --svg --size --title --grey --view --no-legend --html --limit --exact --seconds -q --quiet --bonded --threads --memory"; else files=1; fi ;;
      esac
      ;;
    order)
      case $previous in
        --from) files=1 ;;
        --continue) : ;;
        --at) : ;;
        --reach) words="free line surface" ;;
        --source) : ;;
        --avoid) : ;;
        --keep) : ;;
        --group) : ;;
        --parallel) words="all" ;;
        --seed) : ;;
        --seconds) : ;;
        --help-seconds) : ;;
        --threads) : ;;
        -o|--output) files=1 ;;
        --json) files=1 ;;
        --csv) files=1 ;;
        --html) files=1 ;;
        --certificate) files=1 ;;
        --scatter) : ;;
        --scatter-common) : ;;
        --scatter-mass) : ;;
        --scatter-law) words="lognormal normal weibull" ;;
        --probability) : ;;
        --lose) : ;;
        --lose-seconds) : ;;
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --from --continue --at --reach --source --avoid --keep --group --parallel --pieces --reverse --seed --exact --seconds --help-seconds --threads -q --quiet -o --output --json --csv --html --certificate --strength-needed --stream --scatter --scatter-common --scatter-mass --scatter-law --probability --lose-one --lose --lose-seconds --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin"; else files=1; fi ;;
      esac
      ;;
    move)
      case $previous in
        --continue) : ;;
        --at) : ;;
        --motions) : ;;
        --within) : ;;
        --avoid) : ;;
        --keep) : ;;
        --seed) : ;;
        --seconds) : ;;
        --threads) : ;;
        -o|--output) files=1 ;;
        --json) files=1 ;;
        --csv) files=1 ;;
        --html) files=1 ;;
        --verify) files=1 ;;
        --scatter) : ;;
        --scatter-common) : ;;
        --scatter-mass) : ;;
        --scatter-law) words="lognormal normal weibull" ;;
        --probability) : ;;
        --lose) : ;;
        --lose-seconds) : ;;
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --continue --at --pivot --motions --within --avoid --keep --geometry-only --seed --seconds --threads -q --quiet -o --output --json --csv --html --verify --stream --scatter --scatter-common --scatter-mass --scatter-law --probability --lose-one --lose --lose-seconds --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin"; else files=1; fi ;;
      esac
      ;;
    simulate)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --safety-factor|--margin) : ;;
        --method) words="auto elimination fronts polynomial" ;;
        --link) words="v1 v2 catoms unit" ;;
        --seed) : ;;
        --loss) : ;;
        --duplicate) : ;;
        --reorder) : ;;
        --corrupt) : ;;
        --jitter) : ;;
        --kill) : ;;
        --cut) : ;;
        --detach) : ;;
        --plan) : ;;
        --withdraw) : ;;
        --attach) : ;;
        --weaken) : ;;
        --json) files=1 ;;
        --connections) words="all broken" ;;
        --trace) files=1 ;;
        --story) files=1 ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        --threads) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --safety-factor --margin --method --link --seed --loss --duplicate --reorder --corrupt --jitter --kill --cut --detach --plan --withdraw --attach --steps --stages --next --weaken --json --connections --trace --story --svg --size --title --grey --view --no-legend --threads -q --quiet"; else files=1; fi ;;
      esac
      ;;
    emulate)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --board) words="v2 v1 v2-256k" ;;
        --image) files=1 ;;
        --pages) files=1 ;;
        --seed) : ;;
        --kill) : ;;
        --reset) : ;;
        --cut) : ;;
        --flip) : ;;
        --plan) : ;;
        --withdraw) : ;;
        --attach) : ;;
        --serial) : ;;
        --time) : ;;
        --json) files=1 ;;
        --connections) words="all broken" ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --board --image --pages --bare --seed --kill --reset --cut --flip --plan --withdraw --attach --serial --time --json --connections --svg --size --title --grey --view --no-legend -q --quiet"; else files=1; fi ;;
      esac
      ;;
    listen)
      case $previous in
        --baud) : ;;
        --time) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --baud --once --json --time"; else files=1; fi ;;
      esac
      ;;
    tell)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --baud) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --baud"; else files=1; fi ;;
      esac
      ;;
    twin)
      case $previous in
        --also) : ;;
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --baud) : ;;
        --time) : ;;
        --json) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help --also --robot --lattice --set --support-z --pitch --palette --allow-unknown --baud --time --json -q --quiet"; else files=1; fi ;;
      esac
      ;;
    conformance)
      case $previous in
        --page) files=1 ;;
        --section) words="line link round order refusal watch" ;;
        --baud) : ;;
        --json) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help --page --section --baud --json -q --quiet"; else files=1; fi ;;
      esac
      ;;
    serve)
      case $previous in
        --jobs) : ;;
        --request-seconds) : ;;
        --request-memory) : ;;
        *) if [[ $current == -* ]]; then words="-h --help --mcp --jobs --request-seconds --request-memory"; else :; fi ;;
      esac
      ;;
    convert)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown"; else files=1; fi ;;
      esac
      ;;
    fit)
      case $previous in
        --json) files=1 ;;
        --svg) files=1 ;;
        --size) : ;;
        --title) : ;;
        --view) words="iso front side top" ;;
        *) if [[ $current == -* ]]; then words="-h --help --json --svg --size --title --grey --view --no-legend -q --quiet"; else files=1; fi ;;
      esac
      ;;
    generate)
      case $previous in
        -o|--output) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help -o --output"; else words="arm cube tower scaffold shell portal bridge growth ball sheet prism-wall arch crane stairs wall"; fi ;;
      esac
      ;;
    robots)
      case $previous in
        --json) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help --json"; else files=1; fi ;;
      esac
      ;;
    view)
      case $previous in
        --robot) : ;;
        --lattice) : ;;
        --set) : ;;
        --support-z) : ;;
        --pitch) : ;;
        --palette) files=1 ;;
        --out) files=1 ;;
        *) if [[ $current == -* ]]; then words="-h --help --robot --lattice --set --support-z --pitch --palette --allow-unknown --out --no-open"; else files=1; fi ;;
      esac
      ;;
  esac
  [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [ -n "$files" ]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -F _holdfast holdfast
