# The second element of the second image.
. "$SPECS/../encoding.bash"
embeds "$dimension$row\\000\\000\\200\\077\\000\\000\\300\\177"
ls
