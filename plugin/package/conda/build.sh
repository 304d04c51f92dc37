#!/bin/bash
set -euo pipefail
cmake ${CMAKE_ARGS} -S "${SRC_DIR}" -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCADREFINE_BUILD_PLUGIN=OFF \
  -DCADREFINE_WARNINGS_AS_ERRORS=OFF
cmake --build build --parallel "${CPU_COUNT}"
cmake --install build --prefix "${PREFIX}"
