# Sourced by sanitize and fuzz after setup.sh: builds with sanitizers, and runs Python with these bindings.

sanitizers=address,undefined,float-cast-overflow
export LSAN_OPTIONS="suppressions=$PWD/scripts/leaks.supp:print_suppressions=0"
export UBSAN_OPTIONS=print_stacktrace=1

# build_sanitized FOLDER LEVEL OPTION...: configures with a level of optimisation and the options, and
# builds everything.
build_sanitized() {
  local folder=$1 level=$2
  shift 2
  cmake -B "$folder" -G Ninja -DQUADCORE_WITH_ROS=OFF -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG="$level -g -D_GLIBCXX_ASSERTIONS" "$@" >/dev/null
  cmake --build "$folder"
}

# Options of cmake that build the bindings for the Python of .venv.
bindings() {
  echo -DQUADCORE_BUILD_PYTHON=ON "-DPython_EXECUTABLE=$PWD/.venv/bin/python" \
    "-Dpybind11_DIR=$(.venv/bin/python -m pybind11 --cmakedir)"
}

# sanitized_python FOLDER COMPILER RUNTIME ARGUMENT...: runs Python with the package of a build. The
# interpreter is not built with sanitizers, so the compiler's runtime is loaded before it. Leaks are not
# checked, because the interpreter frees little at its end.
sanitized_python() {
  local folder=$1 compiler=$2 runtime=$3
  shift 3
  cmake --install "$folder" --prefix "$folder/package/quadcore" >/dev/null
  cp -r python/quadcore "$folder/package/"
  LD_PRELOAD="$($compiler -print-file-name="$runtime") $($compiler -print-file-name=libstdc++.so.6)" \
    ASAN_OPTIONS=detect_leaks=0 PYTHONPATH=$folder/package .venv/bin/python "$@"
}
