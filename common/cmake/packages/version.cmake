# Read when cpack runs, whose -R may name another version: the packages of one build belong together.
foreach(upper DAEMON SIMULATION CLIENTS)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "footing-common (= ${CPACK_PACKAGE_VERSION})")
endforeach()
set(CPACK_DEBIAN_ALL_PACKAGE_DEPENDS "footing-daemon (= ${CPACK_PACKAGE_VERSION}), \
footing-simulation (= ${CPACK_PACKAGE_VERSION}), footing-clients (= ${CPACK_PACKAGE_VERSION})")
