/* Lets a folder's library exist before its first source file does. */
typedef int vts_translation_unit_is_not_empty;
