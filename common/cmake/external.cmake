# Every library from outside, under the short name that DEPS uses. All of them are Debian 12's.
# EXTERNAL_PURE are the ones a pure module may name: they neither do I/O nor read a clock.
find_package(Threads REQUIRED)
find_package(Boost 1.81 REQUIRED)
find_package(Protobuf 3.21 REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(mujoco REQUIRED)
# Debian's mujocoConfig names include folders of its own build that do not exist.
find_path(MUJOCO_INCLUDE mujoco/mujoco.h REQUIRED)
set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${MUJOCO_INCLUDE}
                      INTERFACE_LINK_LIBRARIES "")
find_package(ZLIB REQUIRED)
find_package(glfw3 3.3 REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(hidapi REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
find_path(CLI11_INCLUDE CLI/CLI.hpp REQUIRED)

set(EXTERNAL_eigen Eigen3::Eigen)
set(EXTERNAL_boost_headers Boost::headers)
set(EXTERNAL_asio Boost::headers Threads::Threads)
set(EXTERNAL_protobuf protobuf::libprotobuf)
set(EXTERNAL_json nlohmann_json::nlohmann_json)
set(EXTERNAL_spdlog spdlog::spdlog)
set(EXTERNAL_hidapi PkgConfig::hidapi)
set(EXTERNAL_mujoco mujoco::mujoco)
set(EXTERNAL_zlib ZLIB::ZLIB)
set(EXTERNAL_cli11 footing_cli11)
set(EXTERNAL_opengl OpenGL::OpenGL OpenGL::EGL)
set(EXTERNAL_imgui PkgConfig::imgui)
set(EXTERNAL_glfw glfw)
set(EXTERNAL_threads Threads::Threads)
set(EXTERNAL_benchmark benchmark::benchmark)
# MuJoCo is pure in the sense meant here: the same state and inputs give the same bits.
# zlib is named for its CRC-32 only.
set(EXTERNAL_PURE eigen json mujoco zlib)

add_library(footing_cli11 INTERFACE)
target_include_directories(footing_cli11 SYSTEM INTERFACE ${CLI11_INCLUDE})
