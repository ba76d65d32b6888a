# Debian packages of what is installed: `cpack` in the build folder, or scripts/package. Included last, when every
# component has been named.
#
# | package            | holds                                                                        |
# |--------------------|------------------------------------------------------------------------------|
# | footing-daemon     | footingd, its units and config file, the udev rule                           |
# | footing-simulation | footing-sim, its units and config file                                       |
# | footing-clients    | every other program: a new one needs no line here                            |
# | footing-common     | data, messages (.proto), documentation, completion, the user and the group   |
# | python3-footing    | the Python package and its examples                                          |
# | footing            | nothing: needs the others                                                    |
set(sources ${CMAKE_CURRENT_LIST_DIR}/packages)
set(made ${CMAKE_BINARY_DIR}/packaging)
set(FOOTING_PACKAGE_CONTACT "Footing maintainers <maintainers@footing.example>" CACHE STRING
    "Who answers for the packages, NAME <ADDRESS>")
set(packages common daemon simulation clients python all)
set(daemon_components footingd)
set(simulation_components footing-sim)
set(common_components completion data documentation system_user)
set(python_components python)
set(all_components "")
# The text of the licence is part of Debian, and a package says so in its copyright file.
set(unpackaged licence Unspecified)

function(list_client_components out)
  get_cmake_property(components COMPONENTS)
  list(REMOVE_ITEM components ${daemon_components} ${simulation_components} ${common_components} ${python_components}
       ${unpackaged})
  set(${out} ${components} PARENT_SCOPE)
endfunction()
list_client_components(clients_components)

# What a package says of itself. `cmake --install` leaves it out: it belongs to a package only.
file(MAKE_DIRECTORY ${made})
configure_file(${sources}/changelog ${made}/changelog @ONLY)
execute_process(COMMAND gzip -9n -c ${made}/changelog OUTPUT_FILE ${made}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
foreach(package IN LISTS packages)
  set(name footing-${package})
  if(package STREQUAL "all")
    set(name footing)
  elseif(package STREQUAL "python")
    set(name python3-footing)
  endif()
  string(TOUPPER ${package} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  install(FILES ${sources}/copyright ${made}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT about-${package} EXCLUDE_FROM_ALL)
  if(EXISTS ${sources}/${package}/overrides)
    install(FILES ${sources}/${package}/overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${name}
            COMPONENT about-${package} EXCLUDE_FROM_ALL)
  endif()
  list(APPEND ${package}_components about-${package})
endforeach()

# What dpkg runs. A package with units has the scripts that debhelper would write for it.
function(add_scripts package upper)
  set(scripts "")
  foreach(script postinst prerm postrm)
    foreach(folder ${ARGN})
      if(EXISTS ${sources}/${folder}/${script})
        configure_file(${sources}/${folder}/${script} ${made}/${package}/${script} @ONLY)
        list(APPEND scripts ${made}/${package}/${script})
        break()
      endif()
    endforeach()
  endforeach()
  # The administrator's settings: dpkg asks before it replaces one that was edited.
  if(CONFIG_FILE)
    file(WRITE ${made}/${package}/conffiles "${CONFIG_FILE}\n")
    list(APPEND scripts ${made}/${package}/conffiles)
  endif()
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA "${scripts}" PARENT_SCOPE)
endfunction()
set(CONFIG_FILE "")
add_scripts(common COMMON common)
add_scripts(python PYTHON python)
set(UNITS "footingd.socket footingd-devices.socket footingd.service")
set(UNITS_TO_STOP "${UNITS} footingd-metrics.socket")
set(CONFIG_FILE /etc/footing/footingd.json)
# Both services have these folders; who is purged last deletes them.
set(STATE_FOLDERS "/var/lib/footing /run/footing")
set(OTHER_UNIT /usr/lib/systemd/system/footing-sim.service)
set(AFTER_INSTALL [[if command -v udevadm >/dev/null && [ -d /run/udev ]; then
    # Devices that are connected already get their group now.
    udevadm control --reload || true
    udevadm trigger --subsystem-match=hidraw --action=change || true
  fi]])
add_scripts(daemon DAEMON service)
# The socket alone is enabled: it starts footing-sim for the first client, and nothing is computed before.
set(UNITS "footing-sim.socket")
set(UNITS_TO_STOP "footing-sim.socket footing-sim.service footing-sim-metrics.socket")
set(CONFIG_FILE /etc/footing/footing-sim.json)
set(OTHER_UNIT /usr/lib/systemd/system/footingd.service)
set(AFTER_INSTALL ":")
add_scripts(simulation SIMULATION service)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_NAME footing)
set(CPACK_PACKAGE_VENDOR Footing)
set(CPACK_PACKAGE_CONTACT ${FOOTING_PACKAGE_CONTACT})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_STRIP_FILES ON)
# The units and programs name the places below this prefix.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_PROJECT_CONFIG_FILE ${sources}/version.cmake)
foreach(upper DAEMON SIMULATION CLIENTS)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
endforeach()
foreach(upper COMMON PYTHON ALL)
  set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all)
endforeach()
set(CPACK_DEBIAN_COMMON_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers | systemd-sysusers")
set(CPACK_DEBIAN_COMMON_PACKAGE_SUGGESTS bash-completion)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-protobuf (>= 3.20.3), python3-zstandard")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-numpy)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "footing, python3-matplotlib, python3-pandas, python3-zstandard")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_DAEMON_PACKAGE_RECOMMENDS "bluez, udev")
# Opened at run time: the fonts of the screens, and what draws where there is no graphics card.
set(CPACK_DEBIAN_CLIENTS_PACKAGE_RECOMMENDS "fonts-dejavu-core, libgl1-mesa-dri")
set(CPACK_DEBIAN_CLIENTS_PACKAGE_SUGGESTS "bluez, ffmpeg")

# The first line is the summary; CPack would put one of its own before it if it had any.
set(about "Footing animates simulated bodies from inexpensive Bluetooth sensors: swing
two Wii remotes, and a physically simulated biped walks, runs, jumps and turns;
stand on two Balance Boards, and the motion of the whole body is reconstructed.
.")
set(about_common "data and documentation" "This package has what the programs share: models, tracks, the messages
as .proto files, the documentation, and the system user and group footing.")
set(about_daemon "sensor daemon" "This package has footingd, which reads the devices and publishes samples,
features and forces, as a service on sockets of its own.")
set(about_simulation "simulation server" "This package has footing-sim, which drives the biped or reconstructs a
person, as a service that its first client starts.")
set(about_clients "viewer, console and tools" "This package has the viewer, the console, recording, studies, the terrain
game, the device simulator, evaluation and training.")
set(about_python "Python package" "This package reads live samples and recordings, sends commands and simulates
devices from Python 3.")
set(about_all "all programs" "This metapackage needs the packages of all programs and servers.")
foreach(package IN LISTS packages)
  string(TOUPPER ${package} upper)
  list(GET about_${package} 0 title)
  list(GET about_${package} 1 text)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "bodies moved by Bluetooth sensors (${title})\n${about}\n${text}")
endforeach()

set(CPACK_COMPONENTS_ALL "")
foreach(package IN LISTS packages)
  list(APPEND CPACK_COMPONENTS_ALL ${${package}_components})
endforeach()
include(CPack)
foreach(package IN LISTS packages)
  cpack_add_component_group(${package})
  foreach(component IN LISTS ${package}_components)
    cpack_add_component(${component} GROUP ${package})
  endforeach()
endforeach()
