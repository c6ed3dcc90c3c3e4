# The stages of ./check. Sourced by it: uses $all, $base and $stages, and say, configure and build of prepare.sh.
known_stages="format rooms warnings extended controller doxygen clang tidy threads sanitize"

# Tests that share data between threads: work pool, strands, ports, the observers' thread.
thread_programs=(core_test machine_test strand_test deposition_test twin_test)
thread_tests='^(core\.InParallel|machine\.LoopbackPort|strand\.|deposition\.|twin\.)'

# Tests of what the real machine runs. The command line and the reports on top of it are left to the other stages.
sanitize_rooms="core geometry kinematics machine toolpath control vision calibration fuzz"

# How many sources clang-tidy looks at without --all, some 16 s each.
tidy_limit=40

every_source() { git ls-files -co --exclude-standard '*.h' '*.cpp'; }

# With --all, every source; else what changed since the merge base with main, on main itself since the commit before.
changed_sources() {
  if [ "$all" = 1 ]; then every_source; return; fi
  local since=$base main
  for main in origin/main main; do
    [ -n "$since" ] || since=$(git merge-base HEAD $main 2>/dev/null || true)
  done
  if [ -z "$base" ] && [ "$since" = "$(git rev-parse HEAD)" ]; then
    since=$(git rev-parse -q --verify HEAD^ || git hash-object -t tree /dev/null)
  fi
  { git diff --name-only --diff-filter=d "$since" -- '*.h' '*.cpp'; git ls-files -o --exclude-standard '*.h' '*.cpp'; } | sort -u
}

# run_tests PRESET [--fast] CTEST-OPTIONS...: the count of tests, or what failed and where to read more. --fast: those of ./test.
run_tests() {
  local preset=$1 without=slow; shift
  if [ "${1:-}" = --fast ]; then without='slow|extended'; shift; fi
  local log=build/$preset/tests.log
  if ctest --test-dir "build/$preset" --output-on-failure -LE "$without" -j "$(nproc)" --no-tests=error "$@" >"$log" 2>&1; then
    grep 'tests passed' "$log"
    return
  fi
  local reason='SUMMARY: |runtime error: |: Failure$|^C\+\+ exception with description|^(FAIL|ERROR): |^[A-Za-z.]*Error: '
  { { grep -E "$reason" "$log" || true; } | sort -u
    sed -n '/tests passed/p; /The following tests FAILED/,/Errors while/p' "$log"
    echo "$stage: all of it: $log"; } >&2
  return 1
}

stage_format() {
  local wrong
  wrong=$(every_source | xargs -P "$(nproc)" -n 40 clang-format --dry-run -Werror 2>&1 | grep -o '^[^:]*:.*error:' | cut -d: -f1 | sort -u || true)
  [ -z "$wrong" ] || { sed 's/.*/format: & is not formatted: clang-format -i &/' <<<"$wrong" >&2; return 1; }
}

stage_rooms() {
  python3 scripts/check_includes.py "$PWD"
  python3 scripts/check_citations.py "$PWD"
}

# What ./test --werror has built serves; else a folder of its own.
stage_warnings() {
  if grep -qs 'UNDERSTUDY_WERROR:BOOL=ON' build/release/CMakeCache.txt; then build release; else build dev; fi
}

# Its whole log stays: where time runs out, it says which were run.
stage_extended() {
  build release
  run_tests release -L extended
}

stage_controller() {
  if grep -qs 'UNDERSTUDY_WERROR:BOOL=ON' build/release/CMakeCache.txt; then configure controller -DUNDERSTUDY_WERROR=ON; fi
  build controller
  run_tests controller
}

stage_sanitize() {
  if [ "$all" = 1 ]; then
    build asan
    run_tests asan --fast
    return
  fi
  build asan-controller $(printf '%s_test ' $sanitize_rooms)
  say "sanitize: leaves out" $(grep -v '^#' cmake/sanitize_left_out.txt)
  run_tests asan-controller -R "^(${sanitize_rooms// /|})\."
}

# Of libraries that were built without ThreadSanitizer (Mesa, LLVM, OpenCV) it sees calls of malloc and locks, and not how
# they order what they do.
stage_threads() {
  export TSAN_OPTIONS=ignore_noninstrumented_modules=1
  if [ "$all" = 1 ]; then
    build tsan
    run_tests tsan --fast
    return
  fi
  build tsan "${thread_programs[@]}"
  run_tests tsan -R "$thread_tests"
}

# The compile commands of release for clang, in build/clang: each source on its own and without GCC's precompiled header,
# which clang cannot read; both hide a missing include. What the build makes is taken from release.
clang_commands() {
  configure release
  cmake --preset release -B build/clang -DUNDERSTUDY_JOIN=OFF -DUNDERSTUDY_PRECOMPILE=OFF >build/release/clang.log || { cat build/release/clang.log >&2; return 1; }
  sed -i 's|/build/clang/|/build/release/|g' build/clang/compile_commands.json
}

stage_clang() {
  clang_commands
  changed_sources | scripts/affected_sources.py | scripts/clang_syntax.py build/clang
}

stage_tidy() {
  clang_commands
  local sources
  mapfile -t sources < <(changed_sources | scripts/affected_sources.py --one-for-each-header)
  if [ "$all" = 0 ] && [ ${#sources[@]} -gt $tidy_limit ]; then
    say "tidy: looks at $tidy_limit of ${#sources[@]} sources; ./check --all tidy looks at every one"
    sources=("${sources[@]:0:tidy_limit}")
  fi
  printf '%s\n' "${sources[@]}" | scripts/tidy.py build/clang
}

stage_doxygen() {
  mkdir -p build/doxygen
  doxygen docs/Doxyfile
}
