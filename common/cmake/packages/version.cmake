# Read when cpack runs, whose -R may name another version: the packages of one build belong together.
foreach(upper DAEMON SIMULATION CLIENTS)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "footing-common (= ${CPACK_PACKAGE_VERSION})")
endforeach()
# Their units reload by kill, which a minimal Debian does not have.
foreach(upper DAEMON SIMULATION)
  string(APPEND CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS ", procps")
endforeach()
set(CPACK_DEBIAN_ALL_PACKAGE_DEPENDS "footing-daemon (= ${CPACK_PACKAGE_VERSION}), \
footing-simulation (= ${CPACK_PACKAGE_VERSION}), footing-clients (= ${CPACK_PACKAGE_VERSION})")
