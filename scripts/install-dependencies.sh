#!/usr/bin/env bash
# Installs with apt what building, running and testing need and this machine lacks.
#   scripts/install-dependencies.sh [--developer]    also what coverage, clang-tidy and fuzzing need
set -euo pipefail

packages=(
  git cmake g++ ninja-build ccache pkg-config
  libeigen3-dev libceres-dev libopencv-dev libopencv-contrib-dev libboost-graph-dev libvtk9-dev libcli11-dev nlohmann-json3-dev
  libexpected-dev libfmt-dev libssl-dev libjpeg-dev libpng-dev libtinyxml2-dev libyaml-cpp-dev libx11-dev
  zlib1g-dev libglib2.0-dev libprotobuf-dev protobuf-compiler nanopb libnanopb-dev
  qt6-base-dev qt6-serialport-dev libqt6opengl6-dev qt6-tools-dev qt6-tools-dev-tools qt6-l10n-tools libxkbcommon-dev libgl-dev
  qt6-multimedia-dev gstreamer1.0-plugins-base gstreamer1.0-plugins-good libgstreamer1.0-dev
  libgstreamer-plugins-base1.0-dev
  libgl1-mesa-dri
  libgtest-dev libgmock-dev libbenchmark-dev liburdfdom-dev clang-format-14
  xvfb xauth fonts-dejavu-core
)
if [ "${1:-}" = --developer ]; then
  packages+=(clang-14 clang-tidy-14 libclang-rt-14-dev gcovr)
fi

missing=()
for package in "${packages[@]}"; do
  if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
    missing+=("$package")
  fi
done
[ ${#missing[@]} -eq 0 ] && exit 0

sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo)
echo "Installing ${missing[*]}"
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null
