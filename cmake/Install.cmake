# Files that `cmake --install` puts under the prefix, and Debian packages with the same contents:
# parts that need FFmpeg, MPI or cpp-httplib are separate packages.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/etlc")

# ./demo.sh builds only what it runs; nothing is installed before all of it is there.
install(CODE "
foreach(file $<TARGET_FILE:etlc> $<TARGET_FILE:libetlc> $<TARGET_FILE:etlc_read_hdf5>)
  if(NOT EXISTS \"\${file}\")
    message(FATAL_ERROR
      \"There is no \${file}. Build all first:\n  cmake --build ${PROJECT_BINARY_DIR}\")
  endif()
endforeach()")

install(TARGETS etlc EXPORT etlcTargets RUNTIME)
# Where etlc looks for it, relative to bin/.
install(TARGETS etlc_read_hdf5 etlc_read_parquet RUNTIME DESTINATION libexec/etlc)
if(TARGET etlc_embed_worker)
  install(TARGETS etlc_embed_worker etlc_embed_video
    RUNTIME DESTINATION libexec/etlc COMPONENT embed)
endif()
if(TARGET etlc_mpi)
  install(TARGETS etlc_mpi RUNTIME DESTINATION libexec/etlc COMPONENT mpi)
endif()
if(TARGET etlc_serve)
  install(TARGETS etlc_serve RUNTIME DESTINATION libexec/etlc COMPONENT serve)
endif()
install(TARGETS etlmon EXPORT etlmonTargets)
install(TARGETS libetlc EXPORT etlcLibraryTargets)
file(RELATIVE_PATH ETLC_PREFIX_FROM_PC "/usr/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/usr")
configure_file("${CMAKE_CURRENT_LIST_DIR}/etlc.pc.in" "${PROJECT_BINARY_DIR}/etlc.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/etlc.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/runtime/include/etlmon"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.inc" PATTERN "*.def")

install(EXPORT etlcTargets NAMESPACE etlc:: DESTINATION "${package_dir}")
install(EXPORT etlcLibraryTargets NAMESPACE etlc:: DESTINATION "${package_dir}")
install(EXPORT etlmonTargets NAMESPACE etlmon:: DESTINATION "${package_dir}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/etlcConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/etlcConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
# etlc runs on the build machine and the runtime consists of headers, so a cross build may use this
# package.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/etlcConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES "${PROJECT_BINARY_DIR}/etlcConfig.cmake"
  "${PROJECT_BINARY_DIR}/etlcConfigVersion.cmake"
  "${CMAKE_CURRENT_LIST_DIR}/EtlAddMonitor.cmake" DESTINATION "${package_dir}")

# The output of `etlc --man` and `etlc --completion bash`, where man and bash look.
set(manual "${PROJECT_BINARY_DIR}/workbench/driver/manual")
install(FILES "${manual}/etlc.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES "${manual}/etlc" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")

# The pages, and everything that their links lead to.
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  RENAME copyright)
foreach(page README.md CONTRIBUTING.md LICENSE cmake/packages.txt)
  cmake_path(GET page PARENT_PATH folder)
  install(FILES "${PROJECT_SOURCE_DIR}/${page}" DESTINATION "${CMAKE_INSTALL_DOCDIR}/${folder}")
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" "${PROJECT_SOURCE_DIR}/examples"
  "${PROJECT_SOURCE_DIR}/generated" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME etlc)
set(CPACK_PACKAGE_VENDOR "the etlc authors")
set(CPACK_PACKAGE_CONTACT "the etlc authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION devel)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL Unspecified)  # files without an install() of their own
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME etlc)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_RECOMMENDS python3-numpy)
set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "etlc, its library and the runtime of monitors")
if(TARGET etlc_embed_worker)
  list(APPEND CPACK_COMPONENTS_ALL embed)
  set(CPACK_DEBIAN_EMBED_PACKAGE_NAME etlc-embed)
  set(CPACK_DEBIAN_EMBED_PACKAGE_DEPENDS "etlc (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_EMBED_PACKAGE_SUGGESTS libonnxruntime-dev)  # Debian 13 has it
  set(CPACK_COMPONENT_EMBED_DESCRIPTION "Images, video and networks for etlc embed")
  list(APPEND suggested etlc-embed)
endif()
if(TARGET etlc_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME etlc-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "etlc (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_MPI_DESCRIPTION "Shares calls of etlc out among MPI ranks")
  list(APPEND suggested etlc-mpi)
endif()
if(TARGET etlc_serve)
  list(APPEND CPACK_COMPONENTS_ALL serve)
  set(CPACK_DEBIAN_SERVE_PACKAGE_NAME etlc-serve)
  set(CPACK_DEBIAN_SERVE_PACKAGE_DEPENDS "etlc (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_SERVE_DESCRIPTION "Serves the page of etlc label")
  list(APPEND suggested etlc-serve)
endif()
list(JOIN suggested ", " CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
find_program(ETLC_SHLIBDEPS dpkg-shlibdeps)
mark_as_advanced(ETLC_SHLIBDEPS)
if(ETLC_SHLIBDEPS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
else()
  message(STATUS "dpkg-shlibdeps (package dpkg-dev) is missing: a .deb made here would not list "
    "the libraries that etlc needs")
endif()
include(CPack)
