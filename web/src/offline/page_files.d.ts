// The service makes this module: what its pages are made of (app/http/page_files.py).

/** Changes with any of the files. */
export const VERSION: string;
/** Their addresses. */
export const FILES: string[];
