# cmake --install build/release --prefix DIR: the program, the libraries, their headers below
# include/couture, and the package that find_package(couture) finds, with couture::iga, ...
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/couture)

install(TARGETS couture_flags EXPORT couture-targets)
foreach(module iga meshing rom io)
    if(TARGET couture_${module})
        install(TARGETS couture_${module} EXPORT couture-targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
        install(DIRECTORY ${PROJECT_SOURCE_DIR}/${module}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/couture
            FILES_MATCHING PATTERN "*.h")
    endif()
endforeach()
if(TARGET couture)
    install(TARGETS couture RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT couture-targets NAMESPACE couture:: DESTINATION ${package_dir})
configure_package_config_file(
    ${CMAKE_CURRENT_LIST_DIR}/couture-config.cmake.in
    ${PROJECT_BINARY_DIR}/couture-config.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
    ${PROJECT_BINARY_DIR}/couture-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/couture-config.cmake
    ${PROJECT_BINARY_DIR}/couture-config-version.cmake
    ${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake
    DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/REFERENCES.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
