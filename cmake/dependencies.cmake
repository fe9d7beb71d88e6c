# Everything that Couture is linked with, found here and nowhere else: the installed package reads
# this file too. All are Debian 12 packages of cmake/packages.txt.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenMP REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)

# SuiteSparse has no CMake configuration on Debian 12.
find_path(SUITESPARSE_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(UMFPACK_LIBRARY umfpack REQUIRED)
find_library(OPENBLAS_LIBRARY openblas REQUIRED)
mark_as_advanced(SUITESPARSE_INCLUDE_DIR CHOLMOD_LIBRARY UMFPACK_LIBRARY OPENBLAS_LIBRARY)
if(NOT TARGET couture_suitesparse)
    # Imported, so that an installed Couture names it instead of the paths of this machine.
    add_library(couture_suitesparse INTERFACE IMPORTED)
    target_include_directories(couture_suitesparse INTERFACE ${SUITESPARSE_INCLUDE_DIR})
    target_link_libraries(couture_suitesparse INTERFACE
        ${CHOLMOD_LIBRARY} ${UMFPACK_LIBRARY} ${OPENBLAS_LIBRARY})
endif()

pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET PETSc)
# PETSc's headers need mpi.h, which its pkg-config file leaves out.
pkg_check_modules(MPI REQUIRED IMPORTED_TARGET mpi-c)
pkg_check_modules(MUPARSER REQUIRED IMPORTED_TARGET muparser)

# None of these pulls in HDF5: PETSc brings the OpenMPI flavour, VTK's is the serial one.
find_package(VTK 9.1 REQUIRED COMPONENTS
    CommonCore CommonDataModel CommonMisc FiltersCore IOImage IOXML
    RenderingCore RenderingFreeType RenderingOpenGL2)

# The OpenMPI flavour of HDF5: PETSc links it.
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi)
find_package(pugixml REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)

find_package(OpenMesh CONFIG REQUIRED)
find_package(CGAL 5.5 CONFIG REQUIRED)

find_package(Boost REQUIRED)
pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt)
