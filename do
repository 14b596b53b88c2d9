#!/usr/bin/env bash
# Everything that is done with a checkout of pith. `./do` alone lists the verbs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() {
  cat <<'END'
usage: ./do VERB [options]

  deps                           install what pith is built with (apt, Debian 12); nothing to do when it is all there
  build [PRESET]                 configure and build; the program is then build/release/pith
                                 (presets: release, debug, asan, tsan; default release)
  demo                           build, then make, cut and render the kiwi; pictures and model land in build/demo
  gallery [NAME...]              build, then make the models of docs/gallery.md (or those named) and their pictures in
                                 docs/gallery: whole, cut across and cut along
  window                         build, then play the session of docs/window.md without a display and make its pictures
  quality [NAME...]              build, then make the models of docs/quality.md (or those named) and print its table
  test [--oracles] [--slow] [--no-sanitizers]
                                 build and pass the tests, the fast ones under sanitizers too; also those that compare
                                 with other programs, and those that take long
  bench [--only REGEX] [--json FILE] [--repeat N]
                                 build optimised, run the rows of the benchmark table whose names match, print them and
                                 write FILE
  format [--check]               clang-format over pith's sources; --check only says what would change

deps runs by itself before build, demo, gallery, window, quality, test and bench. PITH_SHARED_DATA names a folder of real meshes, images and
volumes that some tests and benchmarks read; without it they are skipped, saying so.
END
}

# What Debian 12 calls the tools and libraries that pith is built with.
packages=(
  build-essential cmake ninja-build pkg-config ccache mold git
  libeigen3-dev libtbb-dev libfmt-dev libcli11-dev nlohmann-json3-dev libzip-dev
  libcgal-dev libtet1.5-dev libopenvdb-dev libboost-iostreams-dev libembree-dev libopenimageio-dev
  libglfw3-dev libepoxy-dev libimgui-dev libegl1 libgl1 libgl1-mesa-dri
  libgtest-dev libbenchmark-dev
)

fail() {
  echo "do: $1" >&2
  exit "${2:-1}"
}
step() { echo "── $*"; }

# Those of the packages named that are not installed.
missing_packages() {
  comm -23 <(printf '%s\n' "$@" | sort) \
    <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' | sort -u)
}

install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    command -v cmake >/dev/null && command -v ninja >/dev/null && return 0 # somebody else has set this machine up
    fail "this is no Debian (there is no apt-get); install what these Debian packages hold, then go on: $*"
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -eq 0 ]] && return 0

  local release=unknown
  [[ -r /etc/os-release ]] && release=$(. /etc/os-release && echo "${ID:-unknown} ${VERSION_ID:-}")
  [[ $release == "debian 12" ]] || echo "do: pith is built on Debian 12, this is $release; trying all the same" >&2
  local as_root=()
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null || fail \
      "installing packages needs root and there is no sudo; as root, run: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  step "installing ${#missing[@]} packages: ${missing[*]}"
  local attempt
  for attempt in 1 2 3; do
    if "${as_root[@]}" apt-get -q -o Acquire::Retries=3 update &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Acquire::Retries=3 \
        install --no-install-recommends "${missing[@]}"; then
      return 0
    fi
    echo "do: apt-get failed (attempt $attempt of 3)" >&2
    [[ $attempt -lt 3 ]] && sleep $((attempt * 10))
  done
  fail "apt-get could not install: ${missing[*]}; see its messages above"
}

deps() { install_packages "${packages[@]}"; }

# How many compilers at once: one a core, as far as memory goes (the largest file takes about 3.5 GB).
compilers() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 2)
  memory=$(awk '/MemAvailable/ { print int($2 / 2500000) }' /proc/meminfo 2>/dev/null || echo "$cores")
  ((memory < 1)) && memory=1
  echo $((cores < memory ? cores : memory))
}

# The folder of real data, where there is one.
shared_data() {
  if [[ -n ${PITH_SHARED_DATA:-} ]]; then
    [[ -d $PITH_SHARED_DATA ]] || fail "PITH_SHARED_DATA=$PITH_SHARED_DATA is not a folder"
    realpath "$PITH_SHARED_DATA"
  elif [[ -d ../shared/data ]]; then
    realpath ../shared/data
  fi
}

configured() { # PRESET [DATA]: with that folder of real data (default: the one there is)
  local log=build/configure-$1.log data
  data=${2-$(shared_data)}
  mkdir -p build
  if ! cmake --preset "$1" -DPITH_SHARED_DATA="$data" >"$log" 2>&1; then
    cat "$log" >&2
    fail "could not configure the $1 build"
  fi
}
built() { # PRESET [TARGET...]: of a configured preset
  local preset=$1
  shift
  step "building ($preset)"
  cmake --build "build/$preset" --parallel "$(compilers)" ${1:+--target "$@"}
}

build() {
  [[ $# -le 1 ]] || fail "build takes one preset: release, debug, asan or tsan" 2
  case ${1:-release} in
  release | debug | asan | tsan) ;;
  *) fail "there is no preset '$1'; there are release, debug, asan and tsan" 2 ;;
  esac
  deps
  configured "${1:-release}"
  built "${1:-release}"
}

demo() {
  [[ $# -eq 0 ]] || fail "demo takes no options" 2
  deps
  configured release
  built release pith
  local pith=build/release/pith out=build/demo
  mkdir -p "$out"
  step "making the kiwi"
  "$pith" make data/recipes/kiwi.json -o "$out/kiwi.pith"
  step "cutting it across and along its axis, one half each; and a recipe that cuts it and lays both halves down"
  "$pith" cut "$out/kiwi.pith" --stroke data/strokes/kiwi-across.json --keep left -o "$out/kiwi-across.pith"
  "$pith" cut "$out/kiwi.pith" --stroke data/strokes/kiwi-along.json --keep left -o "$out/kiwi-along.pith"
  "$pith" make data/recipes/kiwi-halves.json -o "$out/kiwi-halves.pith"
  step "rendering"
  local name
  for name in kiwi kiwi-across kiwi-along; do
    "$pith" render "$out/$name.pith" -o "$out/$name.png" --size 800x600 --spp 48
  done
  "$pith" render "$out/kiwi-halves.pith" -o "$out/kiwi-halves.png" --size 960x640 --spp 96 --direction 0.25,0.75,1.2
  echo
  echo "The model:    $PWD/$out/kiwi.pith   (its pieces: kiwi-across.pith, kiwi-along.pith, kiwi-halves.pith beside it)"
  echo "The pictures: $PWD/$out/kiwi.png          the whole fruit"
  echo "              $PWD/$out/kiwi-across.png   cut across"
  echo "              $PWD/$out/kiwi-along.png    cut along"
  echo "              $PWD/$out/kiwi-halves.png   both halves"
}

# The models of the gallery: name, a plane across, a plane along.
gallery_models=(
  "kiwi        0,0,1,0     0,1,0,0"
  "carrot      0,0,1,20    0,1,0,-1"
  "tree        0,0,1,40    0,1,0,0"
  "watermelon  0,0,1,0     0,1,0,0"
  "tube        0,0,1,0     0,1,0,1"
  "strata      1,0,0,0     0,1,0,0"
  "cake        1,0,0,10    0,1,0,0"
  "mineral     0,0,1,0     0,1,0,0"
  "ripening    0,0,1,0     1,0,0,0"
  "brick       0,0,1,10    1,0,0,15"
  "orange      0,0,1,0     0,1,0,0"
  "banana      1,0,0,30    0,0,1,15.2"
)

gallery() {
  deps
  configured release
  built release pith
  local pith=build/release/pith out=build/gallery entry name across along picture
  mkdir -p "$out" docs/gallery
  for entry in "${gallery_models[@]}"; do
    read -r name across along <<<"$entry"
    [[ $# -eq 0 || " $* " == *" $name "* ]] || continue
    step "$name"
    "$pith" make "data/recipes/$name.json" -o "$out/$name.pith"
    "$pith" cut "$out/$name.pith" --plane "$across" --keep left -o "$out/$name-across.pith"
    "$pith" cut "$out/$name.pith" --plane "$along" --keep left -o "$out/$name-along.pith"
    for picture in "$name" "$name-across" "$name-along"; do
      "$pith" render "$out/$picture.pith" -o "docs/gallery/$picture.jpg" --size 400x320 --spp "${PITH_GALLERY_SPP:-64}"
    done
  done
}

# The pictures of docs/window.md.
window() {
  [[ $# -eq 0 ]] || fail "window takes no options" 2
  deps
  configured release
  built release pith
  mkdir -p docs/window
  step "playing docs/window.json"
  build/release/pith view --replay docs/window.json --panels
}

# The models whose fills are measured: recipes of data/recipes.
quality_models=({table1/,}{kiwi,carrot,tree,tube,strata,watermelon,cake} brick orange)

# What `pith info --quality` says, on standard input, as a row of docs/quality.md. Of several layers the worst counts;
# bold: the target is not met; –: there is nothing of the kind.
quality_row() { # NAME
  awk -v name="$1" '
    function worst(key, value, least) { # least: a larger value is better
      if (!(key in figure) || (least ? value < figure[key] : value > figure[key])) figure[key] = value
    }
    function told(key, digits, bar, least,    text) {
      if (!(key in figure)) return "–"
      text = sprintf("%." digits "f", figure[key])
      return (least ? figure[key] < bar : figure[key] > bar) ? "**" text "**" : text
    }
    function slice(key) { return told(key "coherence", 2, 1.3) " / " told(key "sliced Wasserstein", 2, 1.3) }
    /^  [^ ]/ { things = /\(layer things / }
    !/^    / || (things && !/things that are whole/) { next }
    {
      split(substr($0, 5), words, /   +/)
      measure = words[1]
      value = substr($0, 5 + length(measure))
      sub(/^ +/, "", value)
      sub(/ .*/, "", value)
      if (value ~ /nan|inf/) next
      value += 0
    }
    measure == "points that more than 2 % shines through" { worst("holes", 1e4 * value) }
    measure == "points that more than 1/255 shines through" { worst("thin", 1e4 * value) }
    measure == "masked look-ups per point, 99th percentile" { worst("p99", value) }
    measure == "used share of a mask (on kept look-ups), median" { worst("used", 100 * value, 1) }
    measure ~ /^angle of axis .*median/ { worst("median", value) }
    measure ~ /^angle of axis .*percentile/ { worst("p95", value) }
    measure ~ /^(across [RST]|oblique|near the core): / { worst(measure, value) }
    measure == "things that are whole" { worst("whole", value, 1) }
    measure == "variance where patches mix ÷ interiors" { worst("variance", value, 1) }
    measure ~ /^99th percentile of the gradient/ { worst("gradient", value) }
    END {
      printf "| %s | %s / %s | %s | %s | %s / %s |", name, told("holes", 0, 0), told("thin", 0, 0), told("p99", 0, 25),
        told("used", 0, 70, 1), told("median", 1, 3), told("p95", 1, 15)
      printf " %s | %s | %s | %s |", slice("across R: "), slice("across S: "), slice("across T: "), slice("oblique: ")
      printf " %s | %s | %s | %s |\n", told("variance", 2, 0.9, 1), told("gradient", 2, 1.1), slice("near the core: "),
        told("whole", 0, 95, 1)
    }'
}

quality() {
  deps
  configured release
  built release pith
  local pith=build/release/pith out=build/quality name model
  mkdir -p "$out"
  [[ $# -gt 0 ]] || set -- "${quality_models[@]}"
  for name in "$@"; do
    model=$out/${name//\//-}
    step "$name" >&2
    "$pith" make "data/recipes/$name.json" -o "$model.pith" >&2
    "$pith" info --quality "$model.pith" >"$model.txt"
  done
  echo "| model | holes / thin | layers | used | axes | across R | across S | across T | oblique | variance | gradient | near axis | things |"
  echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
  for name in "$@"; do quality_row "$name" <"$out/${name//\//-}.txt"; done
}

# The test programs that run under the sanitizers: quick ones over the code that handles memory and files.
sanitized=(test_base test_field)

run_tests() {
  local oracle=oracle slow=slow sanitizers=yes
  while [[ $# -gt 0 ]]; do
    case $1 in
    --oracles) oracle=none ;;
    --slow) slow=none ;;
    --no-sanitizers) sanitizers=no ;;
    *) fail "test knows --oracles, --slow and --no-sanitizers, not '$1'" 2 ;;
    esac
    shift
  done
  deps
  configured release
  built release
  if [[ $sanitizers == yes ]]; then
    configured asan "" # without real data: the sanitizers want many small cases, not large ones
    built asan "${sanitized[@]}"
    step "the fast tests under the address and undefined-behaviour sanitizers"
    local pattern
    pattern=$(IFS='|'; echo "${sanitized[*]#test_}")
    ASAN_OPTIONS=detect_leaks=0:abort_on_error=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 \
      ctest --test-dir build/asan -L "^($pattern)\$" -LE '^(oracle|slow)$' --parallel "$(compilers)" --output-on-failure \
      --no-tests=error
  fi
  step "all tests"
  ctest --test-dir build/release -LE "^($oracle|$slow)\$" --parallel "$(compilers)" --output-on-failure --no-tests=error
}

bench() {
  local argument
  for argument in "$@"; do [[ $argument == --help ]] && { usage; return; }; done
  deps
  install_packages libvtk9-dev # the peer of cut/sphere_1m
  configured release
  built release pith pith-bench pith-bench-tetgen >&2
  build/release/pith-bench "$@"
}

format() {
  command -v clang-format >/dev/null || install_packages clang-format
  local sources
  mapfile -t sources < <(git ls-files '*.h' '*.cpp')
  case ${1:-} in
  "") clang-format -i "${sources[@]}" ;;
  --check) clang-format --dry-run -Werror "${sources[@]}" ;;
  *) fail "format knows --check, not '$1'" 2 ;;
  esac
}

verb=${1:-help}
[[ $# -gt 0 ]] && shift
case $verb in
deps | build | demo | gallery | window | quality | bench | format) "$verb" "$@" ;;
test) run_tests "$@" ;;
help | -h | --help) usage ;;
*)
  usage >&2
  fail "there is no verb '$verb'" 2
  ;;
esac
