# A spec saved as UTF-16.
printf '\377\376s\000p\000e\000c\000 \000a\000;\000' > utf16.etl
"$ETLC" utf16.etl --check
