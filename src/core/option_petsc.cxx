// What cdem knows of PETSc's own options (3.18 to 3.24).
#include "core/option_names.hpp"

namespace cdem {

const std::vector<PetscOptionRow> &PetscOptionRows() {
  static const std::vector<PetscOptionRow> rows = {
      {"options_file", "a file", "",
       "reads options: YAML if it ends in .yaml or .yml, else lines of `-option value`; later options win"},
      {"ts_monitor", "a PETSc viewer", "", "prints step and time"},
      {"ts_view", "a PETSc viewer", "", "prints the time stepper after the run"},
      {"log_view", "a PETSc viewer", "", "prints the time of every phase"},
      {"dm_refine", "an integer", "0", "refines the mesh so many times, before it is distributed"},
      {"petscpartitioner_type", "a text", "as PETSc was built", "partitions the mesh: ptscotch, parmetis, simple, ..."},
      {"use_gpu_aware_mpi", "true or false", "true", "whether MPI takes pointers to GPU memory"},
  };
  return rows;
}

const std::vector<std::string> &LatePetscOptions() {
  // Found by giving each of PETSc's options alone and looking at what PetscInitialize leaves, and in the sources.
  static const std::vector<std::string> names = SplitList(
      "help,version,citations,get_total_flops,display,x_view,x_virtual,history,nox,nox_warning,saws_options,blas_view,"
      "options_left,options_view,options_suppress_deprecated_warnings,petsc_viewer_stdout_format,"
      "log,log_all,log_view,log_summary,log_exclude_actions,log_exclude_objects,log_include_actions,log_include_"
      "objects,"
      "log_threshold,log_perfstubs,log_handler_default_use_threadsafe_events,"
      "malloc,malloc_info,malloc_dump,malloc_view,malloc_view_threshold,memory_view,objects_dump,mpidump,"
      "fp_trap,no_signal_handler,on_error_abort,on_error_mpiabort,on_error_malloc_dump,"
      "check_pointer_intensity,error_output_none,error_output_stdout,use_gpu_aware_mpi,"
      "mpi_linear_solver_server_view,mpi_linear_solver_server_use_shared_memory,"
      "device_enable,device_select,device_view,device_enable_host,device_enable_cuda,device_select_cuda,device_view_"
      "cuda,"
      "device_context_device_type,device_context_stream_type,root_device_context_device_type,"
      "root_device_context_stream_type,cuda_device,cuda_set_device,cuda_view,cuda_initialize,"
      "viewer_view,viewer_type,viewer_binary_filename,viewer_binary_mpiio,viewer_binary_skip_header,"
      "viewer_binary_skip_info,viewer_binary_skip_options,viewer_hdf5_base_dimension2,viewer_hdf5_collective,"
      "viewer_hdf5_default_timestepping,viewer_hdf5_sp_output,viewer_socket_machine,viewer_socket_port,"
      "vec_view,vec_view_bounds,vec_view_stash,vec_bind_below,vec_assembly_legacy,vec_mdot_use_gemv,vec_maxpy_use_gemv,"
      "vec_pinned_memory_min,vecstash_initial_size,vecscatter_merge,vecload_block_size,splitreduction_async,"
      "mat_view,is_view,section_view,petscsection_view,sf_concat_view,"
      "sf_type,sf_backend,sf_monitor,sf_rank_order,sf_unknown_input_stream,sf_use_default_stream,sf_use_gpu_aware_mpi,"
      "sf_use_stream_aware_mpi,sf_use_nvshmem,use_nvshmem,sf_window_flavor,sf_window_sync,"
      "dm_view,dm_view_draw_affine,dm_view_draw_cell_color,dm_view_draw_line_color,dm_view_partition,dm_label_view,"
      "dm_partition_view,partition_view,dm_petscsection_view,dm_plex_view_colors,dm_plex_view_colors_depth,"
      "dm_plex_view_coord_system,dm_plex_view_edges,dm_plex_view_hasse,dm_plex_view_hdf5_storage_version,"
      "dm_plex_view_label_filter,dm_plex_view_labels,dm_plex_view_lcolors,dm_plex_view_numbers,dm_plex_view_numbers_"
      "depth,"
      "dm_plex_view_scale,dm_plex_view_tikzscale,"
      "petscpartitioner_type,petscpartitioner_view,petscpartitioner_view_graph,petscpartitioner_use_vertex_weights,"
      "petscpartitioner_use_edge_weights,petscpartitioner_ptscotch_imbalance,petscpartitioner_ptscotch_strategy,"
      "petscpartitioner_parmetis_type,petscpartitioner_parmetis_debug,petscpartitioner_parmetis_seed,"
      "petscpartitioner_parmetis_imbalance_ratio,petscpartitioner_simple_node_grid,"
      "petscpartitioner_simple_process_grid,petscpartitioner_shell_random,"
      "ts_view,ts_view_pre,ts_view_solution,ts_trajectory_view,ts_adapt_view");
  return names;
}

}  // namespace cdem
